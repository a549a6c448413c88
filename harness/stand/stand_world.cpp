#include "harness/stand/stand_world.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/check.hpp"
#include "base/rpm.hpp"

namespace whirl::stand {
namespace {

constexpr const char* kSupply_dip = "supply_dip";
constexpr double kStep_s = 1e-3;
constexpr std::int64_t kStep_ns = 1'000'000;
constexpr double kMost_flow_mps = 20.0;
constexpr double kSlow_radps = 20.0;  // below, loads go with the square of speed

// Which set-points mean something in which mode, and how the mode counts them on the wire.
struct Scale {
  request::SetPointKind kind;
  double to_unit;
  std::initializer_list<io::EscMode> modes;
};
const Scale kScales[] = {
    {request::SetPointKind::duty, 100.0, {io::EscMode::duty}},
    {request::SetPointKind::speed, kRpm_per_radps, {io::EscMode::rpm}},
    {request::SetPointKind::thrust,
     1.0,
     {io::EscMode::thrust_by_rpm, io::EscMode::thrust_by_power}},
    {request::SetPointKind::power, 1.0, {io::EscMode::power}},
};

Throttle::Raw raw_of(const request::RawTransfer& wanted) {
  Throttle::Raw raw;
  raw.write = wanted.write;
  raw.read = wanted.read;
  raw.times = wanted.times;
  raw.every_ns = std::max(kStep_ns, wanted.every_ns / kStep_ns * kStep_ns);
  raw.shift_ns = wanted.shift_ns;
  return raw;
}

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
      throttle_(params.address, params.i2c),
      pulses_(params.motor),
      line_(params.serial) {
  if (params_.pulse_rate_Hz > 0.0) throttle_.never_write();
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
    if (header.kind == io::Kind::shaft_state && header.port == params_.motor) {
      shaft_ = reader.as<io::ShaftState>();
    } else if (header.kind == io::Kind::i2c_reply) {
      throttle_.on_message(reader);
    } else if (header.kind == io::Kind::uart_received) {
      line_.on_message(reader);
    } else if (header.kind == io::Kind::shoot_through) {
      ++shots_;
    } else if (header.kind == io::Kind::board_reset) {
      ++resets_;
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
  plant::RotorConditions conditions;
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
  sensed.add(io::Kind::shaft_load, params_.motor, t_ns, load);
  throttle_.send(t_ns, sensed);
  if (params_.pulse_rate_Hz > 0.0) {
    pulses_.follow(throttle_.value(), throttle_.silent(), params_.pulse_rate_Hz);
  }
  pulses_.send(t_ns, sensed);
  line_.send(t_ns, sensed);
}

// ---- What a plan may ask

Result<Done> StandWorld::command(const Command& command, std::int64_t /*now_ns*/) {
  return std::visit(
      Match{[this](const request::SetPoint& c) { return set(c); },
            [this](const request::Stop&) -> Result<Done> { return throttle_.set(0), Done{}; },
            [this](const request::Silence& c) -> Result<Done> {
              return throttle_.silence(c.silent), Done{};
            },
            [this](const request::SetPointRate& c) -> Result<Done> {
              return throttle_.set_rate(c.rate_Hz), Done{};
            },
            [this](const request::RawTransfer& c) -> Result<Done> {
              return throttle_.send_raw(raw_of(c)), Done{};
            },
            [this](const request::Pulses& c) -> Result<Done> { return pulses_.set(c), Done{}; },
            [this](const request::Line& c) -> Result<Done> { return line_.say(c.text), Done{}; },
            [this](const request::Brake& c) -> Result<Done> {
              brake_Nm_ = c.torque_Nm;
              return Done{};
            },
            [&](const auto&) -> Result<Done> { return not_understood("a stand", word(command)); }},
      command);
}

Result<Done> StandWorld::set(const request::SetPoint& command) {
  for (const Scale& scale : kScales) {
    if (scale.kind != command.kind) continue;
    if (std::find(scale.modes.begin(), scale.modes.end(), params_.mode) == scale.modes.end()) break;
    throttle_.set(io::setpoint_of_value(params_.mode, command.value_SI * scale.to_unit));
    return Done{};
  }
  return refusal(word(command), "the stand's mode is another one", "stand = { mode = ... }");
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
  add_signal("charge_used", D::charge, "of the battery",
             [this] { return battery_.charge_used_C(); });
  add_signal("wind", D::speed, "down along the shaft", [this] { return wind_mps_; });
  add_signal("setpoint", D::none, "0..2047, as commanded",
             [this] { return static_cast<double>(throttle_.value()); });
  add_signal("told_current", D::current, "by the ESC over I2C",
             [this] { return throttle_.reported().current_A; });
  add_signal("told_speed", D::angular_rate, "by the ESC over I2C",
             [this] { return radps_of(throttle_.reported().speed_rpm); });
  add_signal("esc_flags", D::none, "status byte", [this] { return throttle_.reported().flags; });
  add_signal("armed", D::none, "1: the ESC says so", [this] {
    const double flags = throttle_.reported().flags;
    return std::isnan(flags) ? 0.0 : static_cast<double>(static_cast<int>(flags) & 1);
  });
  add_signal("i2c_refused", D::none, "orders without a good answer",
             [this] { return static_cast<double>(throttle_.reported().refused); });
  add_signal("i2c_stretch", D::time, "longest hold of SCL in the latest transfers",
             [this] { return throttle_.reported().stretched_s; });
  add_signal("i2c_raw_replies", D::none, "to raw transfers",
             [this] { return static_cast<double>(throttle_.raw_reported().replies); });
  add_signal("i2c_raw_acked", D::none, "raw transfers acknowledged in all bytes",
             [this] { return static_cast<double>(throttle_.raw_reported().acked); });
  add_signal("i2c_raw_bytes", D::none, "of the last raw read",
             [this] { return throttle_.raw_reported().read_bytes; });
  add_signal("i2c_raw_good", D::none,
             "1: the last raw read had a status, its CRC and only FF after",
             [this] { return throttle_.raw_reported().read_good; });
  add_signal("resets", D::none, "of the ESC, by a watchdog or by itself",
             [this] { return static_cast<double>(resets_); });
  add_signal("shoot_through", D::none, "times that both switches of a leg were on",
             [this] { return static_cast<double>(shots_); });
  for (EscLine::Named& told : line_.signals()) {
    add_signal(told.signal.name, told.signal.dimension, told.signal.about, std::move(told.value));
  }
}

}  // namespace whirl::stand
