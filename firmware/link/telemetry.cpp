#include "firmware/link/telemetry.hpp"

#include <algorithm>

#include "firmware/config/vehicle.hpp"
#include "firmware/link/calibration_request.hpp"

namespace fw {
namespace {

using mavlink::kComponent, mavlink::kSystem, mavlink::Message;

constexpr std::uint32_t kSlotsPerSecond = 200, kGpsSecondsByCapture = 5;

void put_vector(Message& message, std::size_t offset, const Vector3& v) {
  for (unsigned i = 0; i < 3; ++i) message.put(offset + 4 * i, v[i]);
}

std::uint16_t count16(std::uint32_t count) {
  return static_cast<std::uint16_t>(std::min<std::uint32_t>(count, 0xFFFF));
}

}  // namespace

std::span<const std::uint8_t> Telemetry::send(const Message& message) {
  last_ = message;
  return last_.frame(kSystem, kComponent, sequence_++);
}

std::span<const std::uint8_t> Telemetry::next(std::uint32_t time_ms, const Faults& faults,
                                              const Health& health) {
  const std::uint32_t slot = slot_ % kSlotsPerSecond, second = slot_ / kSlotsPerSecond;
  ++slot_;
  if (slot % 10 == 0) return send(attitude(time_ms));
  if (slot % 20 == 3) return send(position(time_ms));
  if (slot % 100 == 19) return send(highres_imu(time_ms));
  if (slot == 21) return send(drag(time_ms));  // in the place of one of five
  if (slot % 40 == 21) return send(filter_attitudes(time_ms));
  if (slot % 40 == 33) return send(filters(time_ms));
  if (slot == 6) return send(heartbeat());
  if (slot == 106) return send(sys_status(faults, health));
  if (slot == 46 && flight_.estimator().gps_frame().known()) return send(gps_origin());
  // While capture comes up, the radio has no more room.
  const bool gps_due = second % kGpsSecondsByCapture == 0 || !flight_.estimator().fix_fresh();
  if (slot == 146 && gps_due) return send(gps_raw(time_ms));
  if (acks_due_ == 0) {
    if (const auto answer = flight_.calibrator().take_answer()) {
      acknowledge(kPreflightCalibration, answer->result, answer->percent);
    }
  }
  if (acks_due_ > 0) return send(ack());
  if (slot % 10 == 2 && requests_.due()) return send(requests_.next(time_ms));
  if (slot % 10 == 7 && parameters_.due()) return send(parameters_.next(flight_.parameters()));
  if (slot % 50 != 8) return {};  // texts are long: four a second at most
  if (!booted_told_ && time_ms > 500) {
    booted_told_ = true;
    return send(status_text(health.boot_text, false));
  }
  if (refusal_due_) {
    refusal_due_ = false;
    return send(status_text(text_of(refusal_), true));
  }
  if (const CalibrationText said = flight_.calibrator().take_text(); said.text != nullptr) {
    return send(status_text(said.text, said.bad));
  }
  if (unsaved_told_ != health.parameters_unsaved) {
    unsaved_told_ = health.parameters_unsaved;
    if (unsaved_told_) return send(status_text("parameters not saved, restart to make room", true));
  }
  // A card has two seconds to come up before it is missed.
  if (log_told_ != health.log_trouble && time_ms > 2000) {
    log_told_ = health.log_trouble;
    if (log_told_ != nullptr) return send(status_text(log_told_, true));
  }
  if (reasons_told_ != flight_.reason_count()) {
    reasons_told_ = flight_.reason_count();
    const bool bad = flight_.emergency() || flight_.state() == FlightState::failsafe;
    return send(status_text(text_of(flight_.last_reason()), bad));
  }
  if (const Reason warning = flight_.take_warning(); warning != Reason::none) {
    return send(status_text(text_of(warning), true));
  }
  return {};
}

Message Telemetry::heartbeat() const {
  constexpr std::uint8_t kQuadrotor = 2, kCustomMode = 0x01, kArmed = 0x80;
  const FlightState state = flight_.state();
  const bool armed = state != FlightState::disarmed;
  std::uint8_t status = 4;
  if (state == FlightState::failsafe) status = 5;
  if (!armed) status = flight_.ready_to_arm() == Reason::none ? 3 : 2;
  if (flight_.emergency()) status = 6;
  Message m(mavlink::kHeartbeat, 9);
  m.put(0, static_cast<std::uint32_t>(state)).put(4, kQuadrotor).put<std::uint8_t>(5, 0);
  m.put(6, static_cast<std::uint8_t>(kCustomMode | (armed ? kArmed : 0))).put(7, status);
  return m.put<std::uint8_t>(8, 3);
}

Message Telemetry::sys_status(const Faults& faults, const Health& health) const {
  // MAV_SYS_STATUS_SENSOR
  constexpr std::uint32_t kGyroAccel = 0x3, kField = 0x4, kPressure = 0x8, kGps = 0x20,
                          kVisionPosition = 0x80, kMotors = 0x8000, kFence = 0x10'0000,
                          kLogging = 0x100'0000, kBattery = 0x200'0000;
  constexpr std::uint32_t kAll = kGyroAccel | kField | kPressure | kGps | kVisionPosition |
                                 kMotors | kFence | kLogging | kBattery;
  const Conditions now = flight_.conditions();
  std::uint32_t healthy = kAll;
  const auto spoils = [&](Condition condition, std::uint32_t bits) {
    if (now.has(condition)) healthy &= ~bits;
  };
  spoils(Condition::imu_not_running, kGyroAccel);
  spoils(Condition::imu_frozen, kGyroAccel);
  spoils(Condition::no_field, kField);
  spoils(Condition::no_pressure, kPressure);
  if (!flight_.estimator().gps().good()) healthy &= ~kGps;
  if (!flight_.estimator().fix_fresh()) healthy &= ~kVisionPosition;
  spoils(Condition::esc_over_current, kMotors);
  spoils(Condition::motor_out, kMotors);
  spoils(Condition::esc_silent, kMotors);
  spoils(Condition::outside_fence, kFence);
  spoils(Condition::battery_low, kBattery);
  if (health.log_trouble != nullptr) healthy &= ~kLogging;
  std::int32_t current_mA = 0;
  for (unsigned i = 0; i < 4; ++i) current_mA += flight_.esc_status(i).current_mA;
  Message m(mavlink::kSysStatus, 31);
  m.put(0, kAll).put(4, kAll).put(8, healthy).put(12, health.load_permille);
  const float battery_mV = 1000.0f * std::clamp(flight_.battery().voltage_V(), 0.0f, 65.0f);
  m.put(14, flight_.battery().connected() ? static_cast<std::uint16_t>(battery_mV)
                                          : std::uint16_t{0xFFFF});
  m.put(16, static_cast<std::int16_t>(current_mA / 10)).put(20, count16(faults.link_bad_frames));
  m.put(22, count16(faults.esc_no_answer)).put(24, count16(faults.i2c_recoveries));
  m.put(26, count16(faults.imu_samples_lost + faults.imu_reconfigured));
  m.put(28, count16(faults.deadline_missed)).put<std::int8_t>(30, -1);
  return m;
}

Message Telemetry::attitude(std::uint32_t time_ms) const {
  const Quaternion& q = flight_.estimator().q_WB();
  Message m(mavlink::kAttitudeQuaternion, 32);
  m.put(0, time_ms).put(4, q.w()).put(8, q.x()).put(12, q.y()).put(16, q.z());
  put_vector(m, 20, flight_.estimator().w_WB_B_radps());
  return m;
}

Message Telemetry::position(std::uint32_t time_ms) const {
  Message m(mavlink::kLocalPositionNed, 28);
  m.put(0, time_ms);
  put_vector(m, 4, flight_.estimator().p_WB_W_m());
  put_vector(m, 16, flight_.estimator().v_WB_W_mps());
  return m;
}

Message Telemetry::highres_imu(std::uint32_t time_ms) const {
  constexpr std::uint16_t kAccelGyroTemperature = 0x103F, kField = 0x01C0, kPressure = 0x0200;
  const Estimator& seen = flight_.estimator();
  std::uint16_t fields = kAccelGyroTemperature;
  Message m(mavlink::kHighresImu, 62);
  m.put(0, std::uint64_t{time_ms} * 1000u);
  put_vector(m, 8, seen.imu().a_B_mps2);
  put_vector(m, 20, seen.imu().w_B_radps);
  if (seen.field_fresh()) {
    put_vector(m, 32, 0.01f * seen.field_B_uT());  // Gauss
    fields |= kField;
  }
  if (seen.pressure_fresh()) {
    m.put(44, 0.01f * seen.pressure_Pa());  // hPa
    fields |= kPressure;
  }
  m.put(56, seen.imu().temperature_degC).put(60, fields);
  return m;
}

Message Telemetry::gps_raw(std::uint32_t time_ms) const {
  const GpsSolution& gps = flight_.estimator().gps();
  const auto cm = [](float m) {
    return static_cast<std::uint16_t>(std::clamp(100.0f * m, 0.0f, 65534.0f));
  };
  constexpr std::uint16_t kUnknownCourse = 0xFFFF;
  Message m(mavlink::kGpsRawInt, 30);
  m.put(0, std::uint64_t{time_ms} * 1000u).put(8, gps.latitude_e7_deg);
  m.put(12, gps.longitude_e7_deg).put(16, gps.height_mm);
  m.put(20, cm(gps.level_accuracy_m)).put(22, cm(gps.down_accuracy_m));
  m.put(24, cm(gps.v_W_mps.head<2>().norm())).put(26, kUnknownCourse);
  return m.put(28, gps.fix_type).put(29, gps.satellites);
}

Message Telemetry::gps_origin() const {
  const GpsFrame& frame = flight_.estimator().gps_frame();
  Message m(mavlink::kGpsGlobalOrigin, 12);
  return m.put(0, frame.latitude_e7_deg())
      .put(4, frame.longitude_e7_deg())
      .put(8, frame.height_mm());
}

// Array 1: scales of filters 1 and 2, velocity through the air, wind, height and its rate by the
// barometer.
Message Telemetry::filters(std::uint32_t time_ms) const {
  const Estimator& e = flight_.estimator();
  Message m = float_array(time_ms, 1, "filters", 10);
  m.put(20, e.body().scale()).put(24, e.inertial().scale());
  put_vector(m, 28, e.body().v_AB_B_mps());
  put_vector(m, 40, e.inertial().wind_W_mps());
  return m.put(52, -e.baro_z_m()).put(56, -e.baro_vz_mps());
}

// Array 2: attitudes of filters 1 and 2, w x y z.
Message Telemetry::filter_attitudes(std::uint32_t time_ms) const {
  Message m = float_array(time_ms, 2, "attitudes", 8);
  std::size_t at = 20;
  for (const Quaternion& q :
       {flight_.estimator().body().q_WB(), flight_.estimator().inertial().q_WB()}) {
    for (const float part : {q.w(), q.x(), q.y(), q.z()}) {
      m.put(at, part);
      at += 4;
    }
  }
  return m;
}

// Array 3: the drag coefficient and its standard deviation, the VelocitySource.
Message Telemetry::drag(std::uint32_t time_ms) const {
  const Estimator& e = flight_.estimator();
  Message m = float_array(time_ms, 3, "drag", 3);
  m.put(20, e.drag().drag_spm()).put(24, e.drag().sigma_spm());
  return m.put(28, static_cast<float>(e.velocity_source()));
}

Message Telemetry::float_array(std::uint32_t time_ms, std::uint16_t id, const char* name,
                               std::uint8_t count) {
  Message m(mavlink::kDebugFloatArray, static_cast<std::uint8_t>(20 + 4 * count));
  m.put(0, std::uint64_t{time_ms} * 1000u).put(8, id);
  for (std::size_t i = 0; i < 10 && name[i] != '\0'; ++i) m.put(10 + i, name[i]);
  return m;
}

Message Telemetry::ack() {
  const Ack first = acks_[0];
  --acks_due_;
  std::copy_n(acks_.begin() + 1, acks_due_, acks_.begin());
  Message m(mavlink::kCommandAck, 4);
  return m.put(0, first.command).put(2, first.result).put(3, first.percent);
}

Message Telemetry::status_text(const char* text, bool bad) {
  constexpr std::uint8_t kCritical = 2, kInfo = 6;
  Message m(mavlink::kStatustext, 51);
  m.put(0, bad ? kCritical : kInfo);
  for (std::size_t i = 0; i < 50 && text[i] != '\0'; ++i) m.put(1 + i, text[i]);
  return m;
}

}  // namespace fw
