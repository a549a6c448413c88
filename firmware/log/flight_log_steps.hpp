// The parts of FlightLog; see flight_log.hpp, which includes this.
#pragma once
#include "firmware/log/flight_log.hpp"

namespace fw {

template <LogSink Volume>
void FlightLog<Volume>::step(std::uint32_t tick, std::uint32_t now_us, std::uint16_t load_permille,
                             std::uint32_t deadlines_missed, TickTimes& times) {
  time_us_ += now_us - now_us_;
  now_us_ = now_us;
  follow_flight(now_us);
  if (volume_.state() != LogState::logging) return;
  if (volume_.files() != files_) begin_file();
  if (next_ < kBegun) {
    if (append_head()) ++next_;
    return;
  }
  if (!wanted_) return;  // it shall run empty now
  append_changes();
  if (!schedule::log(tick) || !may_sample()) return;
  sample(load_permille, deadlines_missed, times);
}

template <LogSink Volume>
void FlightLog<Volume>::follow_flight(std::uint32_t now_us) {
  if (flight_.state() != FlightState::disarmed) {
    disarmed_us_ = now_us;
    if (!wanted_) volume_.open();
    wanted_ = true;
  } else if (wanted_ && now_us - disarmed_us_ > kAfter_us) {
    volume_.close();
    wanted_ = false;
  }
}

// ---- What a file begins with

template <LogSink Volume>
void FlightLog<Volume>::begin_file() {
  files_ = volume_.files();
  next_ = 0;
  samples_ = 0;
  losing_ = false;
  changes_ = flight_.parameters().changes();
  next_parameter_ = kParameterCount;
  reasons_ = flight_.reason_count() - 1;  // the present one is written too
}

template <LogSink Volume>
bool FlightLog<Volume>::append_head() {
  using ulog::Message, ulog::Type;
  if (next_ == kFileHead) return volume_.append(ulog::file_head(time_us_));
  if (next_ == kFlags) return append(Message(Type::flag_bits).put(std::array<std::uint8_t, 40>{}));
  if (next_ < kInfos) return append(Message(Type::format).text(log::kFormats[next_ - kFormats]));
  if (next_ < kParameters) return append(info(next_ - kInfos));
  if (next_ < kSubscriptions) return append(parameter(next_ - kParameters));
  const auto topic = static_cast<std::uint16_t>(next_ - kSubscriptions);
  return append(Message(Type::subscribe)
                    .put(std::uint8_t{0})  // the only one of its kind
                    .put(topic)
                    .text(log::name_of(topic)));
}

template <LogSink Volume>
ulog::Message FlightLog<Volume>::info(unsigned number) {
  switch (number) {
    case 0:
      return ulog::text_info("sys_name", "Whirlstand");
    case 1:
      return ulog::text_info("ver_hw", "PX4FMU_V1");
    case 2:
      return ulog::text_info("sys_mcu", "STM32F405RG");
    default:
      return ulog::text_info("ver_sw", FW_VERSION);
  }
}

template <LogSink Volume>
ulog::Message FlightLog<Volume>::parameter(std::size_t index) const {
  return ulog::Message(ulog::Type::parameter)
      .key("float", kParameterTable[index].name)
      .put(flight_.parameters().value(index));
}

// ---- While it logs

// Why the flight is in its state, and parameters that were set: one message a tick.
template <LogSink Volume>
void FlightLog<Volume>::append_changes() {
  if (losing_) return;
  if (reasons_ != flight_.reason_count()) {
    const bool bad = flight_.emergency() || flight_.state() == FlightState::failsafe;
    if (append(ulog::Message(ulog::Type::text)
                   .put(bad ? ulog::Level::critical : ulog::Level::info)
                   .put(time_us_)
                   .text(text_of(flight_.last_reason())))) {
      reasons_ = flight_.reason_count();
    }
    return;
  }
  if (changes_ != flight_.parameters().changes()) {
    changes_ = flight_.parameters().changes();
    next_parameter_ = 0;
  }
  if (next_parameter_ < kParameterCount && append(parameter(next_parameter_))) ++next_parameter_;
}

// False: this sample is lost. After a gap it waits until there is room for some.
template <LogSink Volume>
bool FlightLog<Volume>::may_sample() {
  if (volume_.room() < (losing_ ? kResume_bytes : kMost_sample_bytes)) {
    if (!losing_) lost_since_us_ = now_us_;
    losing_ = true;
    return false;
  }
  if (!losing_) return true;
  losing_ = false;
  ++dropouts_;
  const std::uint32_t lost_ms = (now_us_ - lost_since_us_ + 999) / 1000;
  return append(ulog::Message(ulog::Type::dropout)
                    .put(static_cast<std::uint16_t>(std::min<std::uint32_t>(lost_ms, 0xFFFF))));
}

template <LogSink Volume>
ulog::Message FlightLog<Volume>::data(log::Topic topic) const {
  return ulog::Message(ulog::Type::data).put(topic).put(time_us_);
}

template <LogSink Volume>
void FlightLog<Volume>::put(ulog::Message& message, const Vector3& v, float scale) {
  for (unsigned i = 0; i < 3; ++i) message.put(scale * v[i]);
}

template <LogSink Volume>
void FlightLog<Volume>::sample(std::uint16_t load_permille, std::uint32_t deadlines_missed,
                               TickTimes& times) {
  using log::Topic;
  const Estimator& seen = flight_.estimator();
  const Quaternion& q = seen.q_WB();
  append(data(Topic::vehicle_attitude).put(q.w()).put(q.x()).put(q.y()).put(q.z()));
  ulog::Message imu = data(Topic::sensor_combined);
  put(imu, seen.imu().w_B_radps);
  put(imu, seen.imu().a_B_mps2);
  append(imu);
  ulog::Message rates = data(Topic::vehicle_angular_velocity);
  put(rates, seen.w_WB_B_radps());
  append(rates);
  ulog::Message position = data(Topic::vehicle_local_position);
  put(position, seen.p_WB_W_m());
  put(position, seen.v_WB_W_mps());
  append(position.put(yaw_of(q)));
  ulog::Message outputs = data(Topic::actuator_outputs).put(std::uint32_t{4});
  for (const std::uint16_t setpoint : flight_.setpoints())
    outputs.put(static_cast<float>(setpoint));
  append(outputs);
  if (samples_ % kSetpointEvery == 0) {
    ulog::Message wanted = data(Topic::vehicle_local_position_setpoint);
    put(wanted, flight_.reference().p_W_m());
    append(wanted.put(flight_.reference().yaw_rad()));
  }
  if (samples_ % kSlowEvery == 1) slow_sample(load_permille, deadlines_missed, times);
  ++samples_;
}

template <LogSink Volume>
void FlightLog<Volume>::slow_sample(std::uint16_t load_permille, std::uint32_t deadlines_missed,
                                    TickTimes& times) {
  using log::Topic;
  append(data(Topic::flight_status)
             .put(flight_.state())
             .put(flight_.last_reason())
             .put(static_cast<std::uint8_t>(flight_.emergency() ? 1 : 0)));
  ulog::Message escs = data(Topic::esc_status).put(std::uint8_t{4});
  float current_A = 0.0f;
  for (unsigned motor = 0; motor < 4; ++motor) {
    const esc::protocol::Status& esc = flight_.esc_status(motor);
    const float of_this_A = 0.001f * static_cast<float>(esc.current_mA);
    current_A += of_this_A;
    escs.put(time_us_).put(static_cast<std::int32_t>(esc.speed_rpm)).put(of_this_A).put(esc.flags);
  }
  append(escs);
  append(data(Topic::battery_status).put(current_A));
  append(data(Topic::cpuload).put(0.001f * static_cast<float>(load_permille)));
  append(data(Topic::flight_timing)
             .put(times.start_us)
             .put(times.setpoint_us)
             .put(times.tick_us)
             .put(deadlines_missed));
  times = {};
  const Estimator& seen = flight_.estimator();
  if (seen.pressure_fresh()) append(data(Topic::vehicle_air_data).put(seen.pressure_Pa()));
  if (!seen.field_fresh()) return;
  ulog::Message field = data(Topic::vehicle_magnetometer);
  put(field, seen.field_B_uT(), 0.01f);
  append(field);
}

}  // namespace fw
