#include "harness/stand/stand_world.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "base/check.hpp"
#include "base/rpm.hpp"
#include "harness/lua/table.hpp"

namespace whirl::stand {
namespace {

constexpr double kStep_s = 1e-3;
constexpr std::int64_t kStep_ns = 1'000'000;
constexpr double kSlow_radps = 20.0;  // below, loads go with the square of speed

struct Wish {
  const char* key;
  Dimension dimension;
  double to_unit;  // of the mode's range on the wire
  std::initializer_list<io::EscMode> modes;
};
const Wish kWishes[] = {
    {"duty", Dimension::ratio, 100.0, {io::EscMode::duty}},
    {"speed", Dimension::angular_rate, kRpm_per_radps, {io::EscMode::rpm}},
    {"thrust", Dimension::force, 1.0, {io::EscMode::thrust_by_rpm, io::EscMode::thrust_by_power}},
    {"power", Dimension::power, 1.0, {io::EscMode::power}},
};

// { bytes = "5A 03 C1", read = 6, times = 10, every = "20 ms", shift = "7 us" }
Throttle::Raw read_raw(const lua::Table& wish) {
  Throttle::Raw raw;
  std::istringstream words(wish.text_or("bytes", ""));
  for (std::string word; words >> word;) {
    unsigned byte = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), byte, 16);
    if (error != std::errc{} || end != word.data() + word.size() || byte > 0xFF) {
      wish.refuse("bytes", "'" + word + "' is no byte", "write them as \"5A 03 C1\"");
    }
    raw.write.push_back(static_cast<std::uint8_t>(byte));
  }
  raw.read = static_cast<std::uint16_t>(wish.integer_or("read", 0, 0, 255));
  raw.times = wish.integer_or("times", 1, 1, 1'000'000);
  raw.every_ns = std::max(kStep_ns, wish.duration_ns_or("every", kStep_ns) / kStep_ns * kStep_ns);
  raw.shift_ns = wish.duration_ns_or("shift", 0);
  if (raw.write.empty() && raw.read == 0)
    wish.refuse("bytes", "nothing to write and nothing to read");
  return raw;
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
  take(happened);
  if (t_ns > 0) move(t_ns);
  now_ns_ = t_ns;
  tell(t_ns, sensed);
}

void StandWorld::take(const io::Batch& happened) {
  for (io::Reader reader(happened.bytes()); reader.next();) {
    const io::Header& header = reader.header();
    if (header.kind == io::Kind::shaft_state && header.port == params_.motor) {
      shaft_ = reader.as<io::ShaftState>();
    } else if (header.kind == io::Kind::i2c_reply) {
      throttle_.take(reader);
    } else if (header.kind == io::Kind::uart_received) {
      line_.take(reader);
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
  for (Dip& dip : dips_) {
    if (now_ns_ < dip.spec.start_ns || now_ns_ >= dip.spec.end_ns) continue;
    dip.applied = true;
    below_V += dip.spec.value;
  }
  battery_.set_dip(below_V);
  battery_.draw(shaft_.source_current_A * kStep_s, kStep_s);
}

void StandWorld::tell(std::int64_t t_ns, io::Batch& sensed) {
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

Result<Done> StandWorld::command(const lua::Table& wish, std::int64_t /*now_ns*/) {
  for (const Wish& w : kWishes) {
    if (!wish.has(w.key)) continue;
    const double value = wish.quantity(w.key, w.dimension, lua::at_least(0.0)) * w.to_unit;
    if (std::find(w.modes.begin(), w.modes.end(), params_.mode) == w.modes.end()) {
      wish.refuse(w.key, "the stand's mode is another one", "stand = { mode = ... }");
    } else {
      throttle_.set(io::setpoint_of_value(params_.mode, value));
    }
  }
  if (wish.has("stop") && wish.flag_or("stop", true)) throttle_.set(0);
  if (wish.has("silence")) throttle_.silence(wish.flag_or("silence", true));
  if (wish.has("i2c_raw")) throttle_.send_raw(read_raw(wish.table("i2c_raw")));
  if (wish.has("setpoint_rate")) {
    throttle_.set_rate(
        wish.quantity("setpoint_rate", Dimension::frequency, lua::between(1.0, 10e3)));
  }
  if (wish.has("pulses")) pulses_.set(read_pulses(wish.table("pulses")));
  if (wish.has("line")) line_.say(wish.text("line"));
  if (wish.has("brake")) {
    brake_Nm_ = wish.quantity("brake", Dimension::torque, lua::between(0.0, 10.0));
  }
  return wish.finish();
}

void StandWorld::blow(double to_mps, std::int64_t start_ns, std::int64_t edge_ns) {
  flow_ = {flow_.at(start_ns), to_mps, start_ns, edge_ns};
}

Result<Done> StandWorld::gust(const lua::Table& wish, std::int64_t now_ns) {
  const double down_mps = wish.quantity("down", Dimension::speed, lua::between(-20.0, 20.0));
  const std::int64_t edge_ns = wish.duration_ns_or("edge", 300 * kStep_ns);
  const bool ends = wish.has("duration");
  const std::int64_t duration_ns = wish.duration_ns_or("duration", 0);
  if (auto good = wish.finish(); !good) return good;
  blow(down_mps, now_ns, edge_ns);
  calm_from_ns_ = ends ? now_ns + duration_ns : INT64_MAX;
  calm_edge_ns_ = edge_ns;
  return Done{};
}

bool StandWorld::take_fault(const FaultSpec& fault) {
  if (fault.kind != "supply_dip") return false;
  dips_.push_back({fault});
  return true;
}

std::vector<std::uint32_t> StandWorld::applied_faults() const {
  std::vector<std::uint32_t> numbers;
  for (const Dip& dip : dips_) {
    if (dip.applied) numbers.push_back(dip.spec.number);
  }
  return numbers;
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
             [this] { return throttle_.told().current_A; });
  add_signal("told_speed", D::angular_rate, "by the ESC over I2C",
             [this] { return radps_of(throttle_.told().speed_rpm); });
  add_signal("esc_flags", D::none, "status byte", [this] { return throttle_.told().flags; });
  add_signal("armed", D::none, "1: the ESC says so", [this] {
    const double flags = throttle_.told().flags;
    return std::isnan(flags) ? 0.0 : static_cast<double>(static_cast<int>(flags) & 1);
  });
  add_signal("i2c_refused", D::none, "orders without a good answer",
             [this] { return static_cast<double>(throttle_.told().refused); });
  add_signal("i2c_stretch", D::time, "longest hold of SCL in the latest transfers",
             [this] { return throttle_.told().stretched_s; });
  add_signal("i2c_raw_replies", D::none, "to raw transfers",
             [this] { return static_cast<double>(throttle_.raw_told().replies); });
  add_signal("i2c_raw_acked", D::none, "raw transfers acknowledged in all bytes",
             [this] { return static_cast<double>(throttle_.raw_told().acked); });
  add_signal("i2c_raw_bytes", D::none, "of the last raw read",
             [this] { return throttle_.raw_told().read_bytes; });
  add_signal("i2c_raw_good", D::none,
             "1: the last raw read had a status, its CRC and only FF after",
             [this] { return throttle_.raw_told().read_good; });
  add_signal("resets", D::none, "of the ESC, by a watchdog or by itself",
             [this] { return static_cast<double>(resets_); });
  add_signal("shoot_through", D::none, "times that both switches of a leg were on",
             [this] { return static_cast<double>(shots_); });
  for (EscLine::Named& told : line_.signals()) {
    add_signal(told.signal.name, told.signal.dimension, told.signal.about, std::move(told.value));
  }
}

}  // namespace whirl::stand
