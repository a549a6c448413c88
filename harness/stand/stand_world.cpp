#include "harness/stand/stand_world.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/check.hpp"
#include "base/rpm.hpp"
#include "harness/stand/current_bound.hpp"
#include "plant/parts/esc_stand.hpp"

namespace whirl::stand {
namespace {

constexpr const char* kSupply_dip = "supply_dip";
constexpr double kStep_s = 1e-3;
constexpr std::int64_t kStep_ns = 1'000'000;
constexpr double kMost_flow_mps = 20.0;
constexpr double kSlow_radps = 20.0;  // below, loads go with the square of speed

std::int64_t ns_of(double seconds) {
  return std::llround(seconds * 1e9);
}

}  // namespace

double StandWorld::Flow::at(std::int64_t t_ns) const {
  const double share = static_cast<double>(t_ns - start_ns) /
                       static_cast<double>(std::max<std::int64_t>(edge_ns, 1));
  return from_mps + (to_mps - from_mps) * std::clamp(share, 0.0, 1.0);
}

StandWorld::StandWorld(const StandParams& params, std::uint64_t seed)
    : params_(params),
      rotor_(params.blade, +1),
      battery_(params.battery),
      cell_(params.cell, seed, "stand.cell"),
      master_(params.esc) {
  name_signals();
}

void StandWorld::read(std::span<double> values) const {
  WHIRL_CHECK(values.size() == values_.size(), values.size(), values_.size());
  for (std::size_t i = 0; i < values_.size(); ++i) values[i] = values_[i]();
}

void StandWorld::step(std::int64_t t_ns, const io::Batch& happened, io::Batch& sensed) {
  on_messages(happened);
  if (t_ns > 0) move(t_ns);
  now_ns_ = t_ns;
  send(t_ns, sensed);
}

void StandWorld::on_messages(const io::Batch& happened) {
  for (io::Reader reader(happened.bytes()); reader.next();) {
    const io::Header& header = reader.header();
    if (header.kind == io::Kind::shaft_state && header.port == params_.esc.motor) {
      shaft_ = reader.as<io::ShaftState>();
    } else if (header.kind == io::Kind::shoot_through) {
      ++shots_;
    } else if (header.kind == io::Kind::board_reset) {
      ++resets_;
    } else {
      master_.on_message(reader);
    }
  }
}

void StandWorld::move(std::int64_t t_ns) {
  WHIRL_CHECK(t_ns == now_ns_ + kStep_ns, t_ns, now_ns_);
  if (t_ns >= calm_from_ns_) {
    blow(0.0, calm_from_ns_, calm_edge_ns_);
    calm_from_ns_ = INT64_MAX;
  }
  wind_mps_ = flow_.at(t_ns);
  // The hub stands still in air that comes down along the shaft: against the air it climbs.
  plant::RotorConditions conditions = params_.still();
  conditions.omega_radps = std::max(kSlow_radps, shaft_.speed_radps);
  conditions.v_AP_P_mps = {0.0, 0.0, -wind_mps_};
  loads_ = rotor_.step(conditions, kStep_s);
  const double slower = std::max(0.0, shaft_.speed_radps) / conditions.omega_radps;  // 1 as a rule
  loads_.thrust_N *= slower * slower;
  loads_.shaft_torque_Nm *= slower * slower;
  weighed_ = cell_.sample(kStep_s, {loads_.thrust_N, loads_.shaft_torque_Nm});

  double below_V = 0.0;
  faults_.apply(kSupply_dip, now_ns_, [&](const FaultSpec& dip) { below_V += dip.value; });
  battery_.set_dip(below_V);
  battery_.draw(shaft_.source_current_A * kStep_s, kStep_s);
}

void StandWorld::send(std::int64_t t_ns, io::Batch& sensed) {
  const double w = std::max(kSlow_radps, shaft_.speed_radps);
  const io::ShaftLoad load{.torque_Nm_s2 = loads_.shaft_torque_Nm / (w * w),
                           .brake_Nm = brake_Nm_,
                           .source_V = std::max(0.0, battery_.source_V()),
                           .source_ohm = battery_.series_resistance_ohm()};
  sensed.add(io::Kind::shaft_load, params_.esc.motor, t_ns, load);
  if (params_.commands) master_.send(t_ns, sensed);
}

// ---- What a plan may ask

Result<Done> StandWorld::command(const Command& command, std::int64_t /*now_ns*/) {
  const auto taken = master_.take(command);
  if (!taken) return taken.error();
  if (taken.value()) return Done{};
  const auto* brake = std::get_if<request::Brake>(&command);
  if (brake == nullptr) return not_understood("a stand", word(command));
  brake_Nm_ = brake->torque_Nm;
  return Done{};
}

void StandWorld::blow(double to_mps, std::int64_t start_ns, std::int64_t edge_ns) {
  flow_ = {flow_.at(start_ns), to_mps, start_ns, edge_ns};
}

Result<Done> StandWorld::disturb(const Disturbance& disturbance, std::int64_t now_ns) {
  const auto* wind = std::get_if<request::Wind>(&disturbance);
  if (wind == nullptr) return not_understood("a stand", word(disturbance));
  for (const auto& [key, value] : {std::pair{"north", wind->north_mps}, {"east", wind->east_mps}}) {
    if (value) return refusal(key, "the stand's flow goes along the shaft only", "down");
  }
  if (wind->after_s) return not_understood("a stand", "after");
  if (!wind->down_mps) return refusal("down", "is missing: a speed is wanted");
  if (!(std::abs(*wind->down_mps) <= kMost_flow_mps)) {
    return refusal("down", "must be at least -20 at most 20 (SI)");
  }
  const std::int64_t edge_ns = wind->edge_s ? ns_of(*wind->edge_s) : 300 * kStep_ns;
  blow(*wind->down_mps, now_ns, edge_ns);
  calm_from_ns_ = wind->duration_s ? now_ns + ns_of(*wind->duration_s) : INT64_MAX;
  calm_edge_ns_ = edge_ns;
  return Done{};
}

Result<bool> StandWorld::take_fault(const FaultSpec& fault) {
  if (fault.kind != kSupply_dip) return false;
  if (auto good = must_be_of_all(fault); !good) return good.error();
  faults_.add(fault);
  return true;
}

Result<double> StandWorld::shortest_rise_s(double from_N, double to_N, double current_A) const {
  return stand::shortest_rise_s(motor_of(params_.stage), params_.blade,
                                {from_N, to_N, current_A, wind_mps_, params_.still()});
}

double StandWorld::sensed_V() const {
  const auto number = [this](const char* name) {
    const auto found = params_.stage.find(name);
    return found == params_.stage.end() ? 0.0 : found->second;
  };
  const double shown_V = shaft_.bus_voltage_V * (1.0 + number("divider.bus"));
  return shown_V * (1.0 + number("adc.gain.bus")) +
         number("adc.offset.bus") / plant::kVoltageDivider;
}

std::string StandWorld::status() const {
  char text[80];
  std::snprintf(text, sizeof text, "%.0f rpm, %.2f N, %.1f A", rpm_of(shaft_.speed_radps),
                loads_.thrust_N, shaft_.bridge_current_A);
  return text;
}

// ---- What a plan may read

void StandWorld::add_signal(std::string name, Dimension dimension, std::string about,
                            std::function<double()> value) {
  signals_.push_back({std::move(name), dimension, std::move(about)});
  values_.push_back(std::move(value));
}

void StandWorld::name_signals() {
  using D = Dimension;
  add_signal("thrust", D::force, "truth", [this] { return loads_.thrust_N; });
  add_signal("cell_thrust", D::force, "as the load cell reads it",
             [this] { return weighed_.thrust_N; });
  add_signal("cell_torque", D::torque, "as the load cell reads it",
             [this] { return weighed_.torque_Nm; });
  add_signal("torque", D::torque, "of the air on the shaft",
             [this] { return loads_.shaft_torque_Nm; });
  add_signal("speed", D::angular_rate, "of the shaft", [this] { return shaft_.speed_radps; });
  add_signal("bus_current", D::current, "into the bridge, mean of 1 ms",
             [this] { return shaft_.bridge_current_A; });
  add_signal("bus_peak", D::current, "into the bridge, largest mean of a PWM period",
             [this] { return shaft_.bridge_peak_A; });
  add_signal("supply_current", D::current, "out of the supply",
             [this] { return shaft_.source_current_A; });
  add_signal("winding_peak", D::current, "largest of 1 ms",
             [this] { return shaft_.winding_peak_A; });
  add_signal("bus_voltage", D::voltage, "at the bridge", [this] { return shaft_.bus_voltage_V; });
  add_signal("sensed_voltage", D::voltage, "as divider and converter of this copy show bus_voltage",
             [this] { return sensed_V(); });
  add_signal("charge_used", D::charge, "of the battery",
             [this] { return battery_.charge_used_C(); });
  add_signal("wind", D::speed, "down along the shaft", [this] { return wind_mps_; });
  add_signal("meter_current", D::current, "as the ammeter reads bus_current",
             [this] { return plant::read_meter(params_.ammeter, shaft_.bridge_current_A); });
  add_signal("meter_voltage", D::voltage, "as the voltmeter reads bus_voltage",
             [this] { return plant::read_meter(params_.voltmeter, shaft_.bus_voltage_V); });
  add_signal("meter_wind", D::speed, "as the anemometer reads wind",
             [this] { return plant::read_meter(params_.anemometer, wind_mps_); });
  for (EscLine::Named& told : master_.signals()) {
    add_signal(told.signal.name, told.signal.dimension, told.signal.about, std::move(told.value));
  }
  add_signal("resets", D::none, "of the ESC, by a watchdog or by itself",
             [this] { return static_cast<double>(resets_); });
  add_signal("shoot_through", D::none, "times that both switches of a leg were on",
             [this] { return static_cast<double>(shots_); });
}

}  // namespace whirl::stand
