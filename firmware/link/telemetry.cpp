#include "firmware/link/telemetry.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {

using mavlink::Frame, mavlink::Message;

constexpr std::uint8_t kSystem = 1, kComponent = 1;
constexpr std::uint32_t kSlotsPerSecond = 200;

enum Command : std::uint16_t { kNavLand = 21, kNavTakeoff = 22, kArmDisarm = 400 };
enum AckResult : std::uint8_t {
  kAccepted = 0,
  kTemporarilyRejected = 1,
  kDenied = 2,
  kUnsupported = 3
};

AckResult result_of(Reason reason) {
  switch (reason) {
    case Reason::none:
      return kAccepted;
    case Reason::wrong_state:
    case Reason::height_out_of_range:
      return kDenied;
    default:
      return kTemporarilyRejected;
  }
}

void put_vector(Message& message, std::size_t offset, const Vector3& v) {
  for (unsigned i = 0; i < 3; ++i) message.put(offset + 4 * i, v[i]);
}

Vector3 get_vector(const Frame& frame, std::size_t offset) {
  return {frame.get<float>(offset), frame.get<float>(offset + 4), frame.get<float>(offset + 8)};
}

std::uint16_t count16(std::uint32_t count) {
  return static_cast<std::uint16_t>(std::min<std::uint32_t>(count, 0xFFFF));
}

}  // namespace

void Telemetry::receive(std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) {
    if (!parser_.push(byte)) continue;
    const Frame& frame = parser_.frame();
    if (frame.id == mavlink::kViconPositionEstimate) on_vicon(frame);
    if (frame.id == mavlink::kSetPositionTargetLocalNed) on_target(frame);
    if (frame.id == mavlink::kCommandLong) on_command(frame);
  }
}

void Telemetry::on_vicon(const Frame& frame) {
  const CaptureFix fix{get_vector(frame, 8), frame.get<float>(20), frame.get<float>(24),
                       frame.get<float>(28)};
  const float sum = fix.p_WB_W_m.sum() + fix.roll_rad + fix.pitch_rad + fix.yaw_rad;
  if (std::isfinite(sum)) flight_.on_fix(fix);
}

void Telemetry::on_target(const Frame& frame) {
  constexpr std::uint16_t kIgnorePosition = 0x0007;
  constexpr std::uint8_t kLocalNed = 1;
  if (frame.get<std::uint8_t>(50) != kSystem || frame.get<std::uint8_t>(52) != kLocalNed) return;
  if ((frame.get<std::uint16_t>(48) & kIgnorePosition) != 0) return;
  const Vector3 p_W = get_vector(frame, 4);
  const float yaw = frame.get<float>(40);
  if (std::isfinite(p_W.sum() + yaw)) flight_.on_target(p_W, wrap_pi(yaw));
}

void Telemetry::on_command(const Frame& frame) {
  if (frame.get<std::uint8_t>(30) != kSystem) return;
  ack_command_ = frame.get<std::uint16_t>(28);
  ack_due_ = true;
  switch (ack_command_) {
    case kArmDisarm:
      ack_reason_ = frame.get<float>(0) > 0.5f ? flight_.arm() : flight_.disarm();
      break;
    case kNavTakeoff:
      ack_reason_ = flight_.take_off(frame.get<float>(24));
      break;
    case kNavLand:
      ack_reason_ = flight_.land();
      break;
    default:
      ack_reason_ = Reason::none;
  }
  refusal_due_ = ack_reason_ != Reason::none;
}

std::span<const std::uint8_t> Telemetry::send(const Message& message) {
  last_ = message;
  return last_.frame(kSystem, kComponent, sequence_++);
}

std::span<const std::uint8_t> Telemetry::next(std::uint32_t time_ms, const Faults& faults,
                                              const Health& health) {
  const std::uint32_t slot = slot_++ % kSlotsPerSecond;
  if (slot % 10 == 0) return send(attitude(time_ms));
  if (slot % 20 == 3) return send(position(time_ms));
  if (slot % 20 == 13) return send(highres_imu(time_ms));
  if (slot == 6) return send(heartbeat());
  if (slot == 106) return send(sys_status(faults, health));
  if (ack_due_) return send(ack());
  if (slot % 50 != 8) return {};  // texts are long: four a second at most
  if (!booted_told_ && time_ms > 500) {
    booted_told_ = true;
    return send(status_text(health.boot_text, false));
  }
  if (refusal_due_) {
    refusal_due_ = false;
    return send(status_text(text_of(ack_reason_), true));
  }
  if (reasons_told_ != flight_.reason_count()) {
    reasons_told_ = flight_.reason_count();
    const bool bad = flight_.emergency() || flight_.state() == FlightState::failsafe;
    return send(status_text(text_of(flight_.last_reason()), bad));
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
  constexpr std::uint32_t kGyroAccel = 0x3, kVisionPosition = 0x80;
  const Reason reason = flight_.ready_to_arm();
  const bool imu_ok = reason != Reason::imu_not_running && reason != Reason::imu_frozen;
  const std::uint32_t healthy =
      (imu_ok ? kGyroAccel : 0) | (flight_.capture_fresh() ? kVisionPosition : 0);
  std::int32_t current_mA = 0;
  for (unsigned i = 0; i < 4; ++i) current_mA += flight_.esc_status(i).current_mA;
  Message m(mavlink::kSysStatus, 31);
  m.put(0, kGyroAccel | kVisionPosition).put(4, kGyroAccel | kVisionPosition).put(8, healthy);
  m.put(12, health.load_permille)
      .put<std::uint16_t>(14, 0xFFFF);  // the bus voltage is not measured
  m.put(16, static_cast<std::int16_t>(current_mA / 10)).put(20, count16(faults.link_bad_frames));
  m.put(22, count16(faults.esc_no_answer)).put(24, count16(faults.i2c_recoveries));
  m.put(26, count16(faults.imu_samples_lost + faults.imu_reconfigured));
  m.put(28, count16(faults.deadline_missed)).put<std::int8_t>(30, -1);
  return m;
}

Message Telemetry::attitude(std::uint32_t time_ms) const {
  const Quaternion& q = flight_.attitude().q_WB();
  Message m(mavlink::kAttitudeQuaternion, 32);
  m.put(0, time_ms).put(4, q.w()).put(8, q.x()).put(12, q.y()).put(16, q.z());
  put_vector(m, 20, flight_.attitude().w_WB_B_radps());
  return m;
}

Message Telemetry::position(std::uint32_t time_ms) const {
  Message m(mavlink::kLocalPositionNed, 28);
  m.put(0, time_ms);
  put_vector(m, 4, flight_.position().p_WB_W_m());
  put_vector(m, 16, flight_.position().v_WB_W_mps());
  return m;
}

Message Telemetry::highres_imu(std::uint32_t time_ms) const {
  constexpr std::uint16_t kAccelGyroTemperature = 0x103F;
  Message m(mavlink::kHighresImu, 62);
  m.put(0, std::uint64_t{time_ms} * 1000u);
  put_vector(m, 8, flight_.imu().a_B_mps2);
  put_vector(m, 20, flight_.imu().w_B_radps);
  m.put(56, flight_.imu().temperature_degC).put(60, kAccelGyroTemperature);
  return m;
}

Message Telemetry::ack() {
  ack_due_ = false;
  const bool known =
      ack_command_ == kArmDisarm || ack_command_ == kNavTakeoff || ack_command_ == kNavLand;
  Message m(mavlink::kCommandAck, 3);
  m.put(0, ack_command_);
  return m.put(2, static_cast<std::uint8_t>(known ? result_of(ack_reason_) : kUnsupported));
}

Message Telemetry::status_text(const char* text, bool bad) {
  constexpr std::uint8_t kCritical = 2, kInfo = 6;
  Message m(mavlink::kStatustext, 51);
  m.put(0, bad ? kCritical : kInfo);
  for (std::size_t i = 0; i < 50 && text[i] != '\0'; ++i) m.put(1 + i, text[i]);
  return m;
}

}  // namespace fw
