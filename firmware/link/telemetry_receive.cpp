// What comes over the radio.
#include "firmware/link/calibration_request.hpp"
#include "firmware/link/telemetry.hpp"

namespace fw {
namespace {

using mavlink::Frame, mavlink::kSystem;

enum Command : std::uint16_t {
  kNavLand = 21,
  kNavTakeoff = 22,
  kArmDisarm = 400,
  kRequestMessage = 512,
  kRequestCapabilities = 520
};
constexpr float kForce = 21196.0f;  // of MAV_CMD_COMPONENT_ARM_DISARM, its second parameter
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

Vector3 get_vector(const Frame& frame, std::size_t offset) {
  return {frame.get<float>(offset), frame.get<float>(offset + 4), frame.get<float>(offset + 8)};
}

}  // namespace

void Telemetry::receive(std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) {
    if (!parser_.push(byte)) continue;
    const Frame& frame = parser_.frame();
    if (frame.id == mavlink::kViconPositionEstimate) on_vicon(frame);
    if (frame.id == mavlink::kSetPositionTargetLocalNed) on_target(frame);
    if (frame.id == mavlink::kSetAttitudeTarget) on_attitude(frame);
    if (frame.id == mavlink::kCommandLong) on_command(frame);
    flight_.on_link();
    requests_.on_frame(frame);
    if (const auto command = requests_.take_command_int()) acknowledge(*command, kUnsupported);
    const bool in_use = flight_.state() != FlightState::disarmed || flight_.falling();
    parameters_.on_frame(frame, flight_.parameters(), in_use);
  }
}

void Telemetry::on_vicon(const Frame& frame) {
  const CaptureFix fix{get_vector(frame, 8), frame.get<float>(20), frame.get<float>(24),
                       frame.get<float>(28)};
  const float sum = fix.p_WB_W_m.sum() + fix.roll_rad + fix.pitch_rad + fix.yaw_rad;
  if (std::isfinite(sum)) flight_.on_fix(fix);
}

// By what its mask leaves in: a velocity without a place; a place with velocity and acceleration, thus
// a trajectory's point; a place.
void Telemetry::on_target(const Frame& frame) {
  constexpr std::uint16_t kNoLevelPosition = 0x0003, kNoHeight = 0x0004, kNoVelocity = 0x0038,
                          kNoAcceleration = 0x01C0;
  constexpr std::uint8_t kLocalNed = 1;
  if (!mavlink::for_us(frame, 50) || frame.get<std::uint8_t>(52) != kLocalNed) return;
  const auto mask = frame.get<std::uint16_t>(48);
  if ((mask & kNoHeight) != 0) return;
  const Vector3 p_W = get_vector(frame, 4), v_W = get_vector(frame, 16),
                a_W = get_vector(frame, 28);
  const float yaw = frame.get<float>(40);
  if (!std::isfinite(p_W.sum() + v_W.sum() + a_W.sum() + yaw)) return;
  const float heading = wrap_pi(yaw);
  if ((mask & kNoLevelPosition) == kNoLevelPosition) {
    if ((mask & kNoVelocity) == 0) flight_.on_velocity(v_W, p_W.z(), heading);
  } else if ((mask & kNoLevelPosition) == 0) {
    if ((mask & (kNoVelocity | kNoAcceleration)) == 0) {
      return flight_.on_trajectory({p_W, v_W, a_W, heading});
    }
    flight_.on_target(p_W, heading);
  }
}

// Flown is one mask: attitude, thrust and the rate of yaw, which carries the heading on between two
// messages. Rates of roll and pitch come from the reference.
void Telemetry::on_attitude(const Frame& frame) {
  constexpr std::uint8_t kNoRollAndPitchRate = 0x03;
  if (frame.get<std::uint8_t>(36) != kSystem) return;
  if (frame.get<std::uint8_t>(38) != kNoRollAndPitchRate) return;
  const Quaternion q_WB(frame.get<float>(4), frame.get<float>(8), frame.get<float>(12),
                        frame.get<float>(16));
  const auto yaw_rate = frame.get<float>(28), thrust = frame.get<float>(32);
  const float norm = q_WB.norm();
  if (!(norm > 0.99f && norm < 1.01f) || !std::isfinite(yaw_rate)) return;
  if (!(thrust >= 0.0f && thrust <= 1.0f)) return;
  flight_.on_attitude(q_WB.normalized(), yaw_rate, thrust);
}

void Telemetry::on_command(const Frame& frame) {
  if (!mavlink::for_us(frame, 30)) return;
  const auto command = frame.get<std::uint16_t>(28);
  Reason reason = Reason::none;
  switch (command) {
    case kArmDisarm:
      reason = arm_or_disarm(frame.get<float>(0) > 0.5f, frame.get<float>(4) == kForce);
      break;
    case kNavTakeoff:
      reason = flight_.take_off(frame.get<float>(24));
      break;
    case kNavLand:
      reason = flight_.land();
      break;
    case kPreflightCalibration:
      return on_calibration(frame);
    case kRequestMessage:
      return on_request_message(frame.get<float>(0));
    case kRequestCapabilities:
      requests_.on_version_wanted();
      break;
    default:
      return acknowledge(command, kUnsupported);
  }
  if (reason != Reason::none) return refuse(command, reason);
  acknowledge(command, kAccepted);
}

void Telemetry::refuse(std::uint16_t command, Reason reason) {
  acknowledge(command, result_of(reason));
  refusal_ = reason;
  refusal_due_ = true;
}

void Telemetry::on_calibration(const Frame& frame) {
  const auto what = calibration_asked(frame);
  if (!what) return acknowledge(kPreflightCalibration, kUnsupported);
  const Reason reason = flight_.calibrate(*what);
  if (reason != Reason::none) return refuse(kPreflightCalibration, reason);
  // What runs tells how far it is by itself.
  if (*what == Calibration::none) acknowledge(kPreflightCalibration, kAccepted);
}

Reason Telemetry::arm_or_disarm(bool arm, bool force) {
  if (force) return arm ? flight_.restart() : flight_.kill();
  return arm ? flight_.arm() : flight_.disarm();
}

// Numbers of messages travel as floats. Those of the slots come by themselves.
void Telemetry::on_request_message(float message) {
  const bool version = message == static_cast<float>(mavlink::kAutopilotVersion);
  if (version) requests_.on_version_wanted();
  acknowledge(kRequestMessage, version ? kAccepted : kDenied);
}

void Telemetry::acknowledge(std::uint16_t command, std::uint8_t result, std::uint8_t percent) {
  if (acks_due_ < acks_.size()) acks_[acks_due_++] = {command, result, percent};
}

}  // namespace fw
