#include "harness/flight/station.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::flight {
namespace {

constexpr std::uint8_t kVehicle = 1;
constexpr std::int64_t kRetry_ns = 300'000'000;
constexpr int kTries = 20;
constexpr std::int64_t kTargetPeriod_ns = 100'000'000;
constexpr std::uint16_t kPositionAndYaw = 0x09F8;  // type_mask: ignore all else
constexpr std::uint8_t kLocalNed = 1;

}  // namespace

Station::Station()
    : parser_(
          [this](const io::MavlinkFrame& frame, std::span<const std::uint8_t>) { hear(frame); }) {}

void Station::send_pose(const CapturedPose& pose, const Send& send) {
  io::ViconPositionEstimate message;
  message.usec = static_cast<std::uint64_t>(pose.exposed_ns / 1000);
  message.x = static_cast<float>(pose.p_WB_W_m.x());
  message.y = static_cast<float>(pose.p_WB_W_m.y());
  message.z = static_cast<float>(pose.p_WB_W_m.z());
  message.roll = static_cast<float>(pose.roll_pitch_yaw_rad.x());
  message.pitch = static_cast<float>(pose.roll_pitch_yaw_rad.y());
  message.yaw = static_cast<float>(pose.roll_pitch_yaw_rad.z());
  send(pose.sent_ns, io::encode(io::pack(message, sender_)));
}

void Station::command(std::uint16_t command, const std::array<float, 7>& param) {
  Pending pending;
  pending.message.command = command;
  pending.message.param = param;
  pending.message.target_system = kVehicle;
  pending.message.target_component = kVehicle;
  commands_.push_back(pending);
  last_result_ = kWaiting;
}

void Station::step(std::int64_t t_ns, const Send& send) {
  if (target_ && t_ns >= next_target_ns_) {
    io::SetPositionTargetLocalNed message;
    message.time_boot_ms = static_cast<std::uint32_t>(t_ns / 1'000'000);
    message.x = static_cast<float>(target_->p_W_m.x());
    message.y = static_cast<float>(target_->p_W_m.y());
    message.z = static_cast<float>(target_->p_W_m.z());
    message.yaw = static_cast<float>(target_->yaw_rad);
    message.type_mask = kPositionAndYaw;
    message.target_system = message.target_component = kVehicle;
    message.coordinate_frame = kLocalNed;
    send(t_ns, io::encode(io::pack(message, sender_)));
    next_target_ns_ = t_ns + kTargetPeriod_ns;
  }
  if (commands_.empty() || t_ns < commands_.front().next_ns) return;
  Pending& first = commands_.front();
  if (first.tries == kTries) {
    last_result_ = kUnanswered;
    commands_.pop_front();
    return;
  }
  first.message.confirmation = static_cast<std::uint8_t>(first.tries++);
  first.next_ns = t_ns + kRetry_ns;
  send(t_ns, io::encode(io::pack(first.message, sender_)));
}

void Station::receive(std::span<const std::uint8_t> bytes, std::int64_t t_ns) {
  heard_ns_ = t_ns;
  for (const std::uint8_t byte : bytes) parser_.add(byte);
}

void Station::acknowledged(const io::CommandAck& ack) {
  if (commands_.empty() || ack.command != commands_.front().message.command) return;
  last_result_ = ack.result;
  commands_.pop_front();
}

void Station::hear(const io::MavlinkFrame& frame) {
  ++telemetry_.frames;
  if (const auto beat = io::unpack<io::Heartbeat>(frame)) {
    telemetry_.state = beat->custom_mode;
    telemetry_.armed = (beat->base_mode & 0x80) != 0 ? 1.0 : 0.0;
    heartbeat_ns_ = heard_ns_;
  } else if (const auto ack = io::unpack<io::CommandAck>(frame)) {
    acknowledged(*ack);
  } else if (const auto position = io::unpack<io::LocalPositionNed>(frame)) {
    telemetry_.north_m = position->x;
    telemetry_.east_m = position->y;
    telemetry_.height_m = -position->z;
  } else if (const auto status = io::unpack<io::SysStatus>(frame)) {
    telemetry_.voltage_V = status->voltage_battery / 1000.0;
    telemetry_.current_A = status->current_battery / 100.0;
    telemetry_.load = status->load / 1000.0;
  } else if (const auto attitude = io::unpack<io::AttitudeQuaternion>(frame)) {
    // cos(tilt) is the z-z element of the rotation: 1 - 2 (x^2 + y^2).
    const double x = attitude->q2, y = attitude->q3;
    telemetry_.tilt_rad = std::acos(std::clamp(1.0 - 2.0 * (x * x + y * y), -1.0, 1.0));
  } else if (const auto text = io::unpack<io::Statustext>(frame)) {
    last_text_ = text->string();
  }
}

Telemetry Station::telemetry(std::int64_t now_ns) const {
  Telemetry told = telemetry_;
  if (heartbeat_ns_ >= 0) told.heartbeat_age_s = static_cast<double>(now_ns - heartbeat_ns_) * 1e-9;
  return told;
}

}  // namespace whirl::flight
