#include "harness/stand/esc_master.hpp"

#include <algorithm>
#include <cmath>

#include "base/rpm.hpp"

namespace whirl::stand {
namespace {

constexpr std::int64_t kGrain_ns = 1'000'000;

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
  raw.every_ns = std::max(kGrain_ns, wanted.every_ns / kGrain_ns * kGrain_ns);
  raw.shift_ns = wanted.shift_ns;
  return raw;
}

}  // namespace

EscMaster::EscMaster(const EscMasterParams& params)
    : params_(params),
      throttle_(params.address, params.i2c),
      can_(params.motor, params.can, params.rpm_command),
      pulses_(params.motor),
      line_(params.serial) {
  if (params_.pulse_rate_Hz > 0.0) throttle_.never_write();
}

void EscMaster::set(std::uint16_t v) {
  throttle_.set(v);
  can_.set(v);
}

Result<bool> EscMaster::take(const Command& command) {
  return std::visit(
      Match{[this](const request::SetPoint& c) { return set(c); },
            [this](const request::Stop&) -> Result<bool> { return set(std::uint16_t{0}), true; },
            [this](const request::Silence& c) -> Result<bool> {
              return throttle_.silence(c.silent), can_.silence(c.silent), true;
            },
            [this](const request::SetPointRate& c) -> Result<bool> {
              return throttle_.set_rate(c.rate_Hz), can_.set_rate(c.rate_Hz), true;
            },
            [this](const request::RawTransfer& c) -> Result<bool> {
              return throttle_.send_raw(raw_of(c)), true;
            },
            [this](const request::Pulses& c) -> Result<bool> { return pulses_.set(c), true; },
            [this](const request::Line& c) -> Result<bool> { return line_.say(c.text), true; },
            [](const auto&) -> Result<bool> { return false; }},
      command);
}

Result<bool> EscMaster::set(const request::SetPoint& command) {
  for (const Scale& scale : kScales) {
    if (scale.kind != command.kind) continue;
    if (std::find(scale.modes.begin(), scale.modes.end(), params_.mode) == scale.modes.end()) break;
    set(io::setpoint_of_value(params_.mode, command.value_SI * scale.to_unit));
    return true;
  }
  return refusal(word(command), "the stand's mode is another one", "stand = { mode = ... }");
}

void EscMaster::on_message(const io::Reader& message) {
  if (message.header().kind == io::Kind::i2c_reply) throttle_.on_message(message);
  if (on_can() && message.header().kind == io::Kind::can_transfer) can_.on_message(message);
  if (message.header().kind == io::Kind::uart_received) line_.on_message(message);
}

void EscMaster::send(std::int64_t t_ns, io::Batch& sensed) {
  on_can() ? can_.send(t_ns, sensed) : throttle_.send(t_ns, sensed);
  if (params_.pulse_rate_Hz > 0.0) {
    pulses_.follow(throttle_.value(), throttle_.silent(), params_.pulse_rate_Hz);
  }
  pulses_.send(t_ns, sensed);
  line_.send(t_ns, sensed);
}

std::vector<EscLine::Named> EscMaster::signals() const {
  using D = Dimension;
  std::vector<EscLine::Named> all;
  const auto add = [&](const char* name, D dimension, const char* about,
                       std::function<double()> value) {
    all.push_back({{name, dimension, about}, std::move(value)});
  };
  add("setpoint", D::none, "0..2047, as commanded",
      [this] { return static_cast<double>(throttle_.value()); });
  add("told_current", D::current, "by the ESC over its bus",
      [this] { return reported().current_A; });
  add("told_speed", D::angular_rate, "by the ESC over its bus",
      [this] { return radps_of(reported().speed_rpm); });
  add("esc_flags", D::none, "status byte", [this] { return reported().flags; });
  add("armed", D::none, "1: the ESC says so", [this] {
    const double flags = reported().flags;
    return std::isnan(flags) ? 0.0 : static_cast<double>(static_cast<int>(flags) & 1);
  });
  add("i2c_refused", D::none, "orders without a good answer",
      [this] { return static_cast<double>(throttle_.reported().refused); });
  add("i2c_stretch", D::time, "longest hold of SCL in the latest transfers",
      [this] { return throttle_.reported().stretched_s; });
  add("i2c_raw_replies", D::none, "to raw transfers",
      [this] { return static_cast<double>(throttle_.raw_reported().replies); });
  add("i2c_raw_acked", D::none, "raw transfers acknowledged in all bytes",
      [this] { return static_cast<double>(throttle_.raw_reported().acked); });
  add("i2c_raw_bytes", D::none, "of the last raw read",
      [this] { return throttle_.raw_reported().read_bytes; });
  add("i2c_raw_good", D::none, "1: the last raw read had a status, its CRC and only FF after",
      [this] { return throttle_.raw_reported().read_good; });
  for (EscLine::Named& told : line_.signals()) all.push_back(std::move(told));
  return all;
}

}  // namespace whirl::stand
