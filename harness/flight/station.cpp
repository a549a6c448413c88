#include "harness/flight/station.hpp"

#include <algorithm>
#include <cmath>

#include "harness/flight/vehicle_system.hpp"

namespace whirl::flight {
namespace {

constexpr std::int64_t kRetry_ns = 300'000'000;
constexpr int kTries = 20;
constexpr std::int64_t kTargetPeriod_ns = 100'000'000, kAttitudePeriod_ns = 50'000'000;
constexpr double kOldNews_s = 3.5;
// type_mask: ignore all else.
constexpr std::uint16_t kPositionAndYaw = 0x09F8, kPathPoint = 0x0800, kVelocityAtHeight = 0x09C3;
constexpr std::uint8_t kAttitudeAndYawRate = 0x03;
constexpr std::uint8_t kLocalNed = 1;

}  // namespace

Station::Station()
    : parser_(
          [this](const io::MavlinkFrame& frame, std::span<const std::uint8_t>) { hear(frame); }) {}

void Station::send_pose(const CapturedPose& pose, const Send& send) {
  last_pose_ = pose;
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

// ---- What is commanded, and when it has passed the wire

void Station::await(Awaited what) {
  awaited_ = what;
  carriers_.clear();
  on_wire_ns_ = -1;
  for (Pending& earlier : commands_) earlier.newest = false;
}

void Station::carry(const io::MavlinkFrame& frame, Awaited what) {
  if (awaited_ == what) carriers_.push_back(io::encode(frame));
}

void Station::delivered(std::span<const std::uint8_t> frame, std::int64_t t_ns) {
  const bool carries = std::any_of(carriers_.begin(), carriers_.end(), [frame](const auto& bytes) {
    return std::equal(bytes.begin(), bytes.end(), frame.begin(), frame.end());
  });
  if (!carries) return;
  on_wire_ns_ = t_ns;
  awaited_ = Awaited::nothing;
  carriers_.clear();
}

void Station::set_target(const std::optional<Target>& target) {
  await(target ? Awaited::target : Awaited::nothing);
  target_ = target;
  goal_speed_mps_ = 0.0;
  path_ = nullptr;
  guide_ = nullptr;
  cruise_W_mps_.reset();
  attitude_.reset();
}

void Station::follow(const Path& path, double yaw_rad) {
  set_target(Target{path(0.0).p_W_m, yaw_rad});
  path_ = path;
  path_start_ns_ = last_step_ns_;
}

void Station::cruise(const Eigen::Vector3d& v_W_mps, const Target& at_height) {
  set_target(at_height);
  cruise_W_mps_ = v_W_mps;
}

void Station::hold(const HeldAttitude& attitude, const Target& after) {
  set_target(after);
  attitude_ = attitude;
  next_target_ns_ = std::min(next_target_ns_, last_step_ns_);
}

void Station::guide(const Guide& guide) {
  set_target(guide(last_step_ns_).target);
  guide_ = guide;
}

void Station::move_target(const Target& goal, double speed_mps) {
  await(Awaited::target);
  const Target from = target_.value_or(goal);
  set_target(from);
  target_->yaw_rad = goal.yaw_rad;
  goal_W_m_ = goal.p_W_m;
  goal_speed_mps_ = speed_mps;
}

void Station::command(std::uint16_t command, const std::array<float, 7>& param) {
  await(Awaited::command);
  Pending pending;
  pending.message.command = command;
  pending.message.param = param;
  pending.message.target_system = kVehicle;
  pending.message.target_component = kVehicle;
  commands_.push_back(pending);
  last_result_ = kWaiting;
}

void Station::request_parameter(const std::string& name, std::optional<float> value) {
  await(Awaited::nothing);
  parameters_.add(name, value);
}

void Station::step(std::int64_t t_ns, const Send& send) {
  if (target_ && goal_speed_mps_ > 0.0) {
    const Eigen::Vector3d left_m = goal_W_m_ - target_->p_W_m;
    const double reach_m = goal_speed_mps_ * static_cast<double>(t_ns - last_step_ns_) * 1e-9;
    target_->p_W_m += left_m.norm() <= reach_m ? left_m : left_m.normalized() * reach_m;
  }
  if (path_) target_->p_W_m = path_(static_cast<double>(t_ns - path_start_ns_) * 1e-9).p_W_m;
  if (guide_) {
    const SetPoint now = guide_(t_ns);
    target_ = now.target;
    cruise_W_mps_ = now.v_W_mps;
  }
  last_step_ns_ = t_ns;
  if (target_ && t_ns >= next_target_ns_) send_target(t_ns, send);
  if (!commands_.empty() && t_ns >= commands_.front().next_ns) send_command(t_ns, send);
  if (const auto frame = parameters_.step(t_ns, sender_)) send(t_ns, io::encode(*frame));
}

void Station::send_attitude(std::int64_t t_ns, const Send& send) {
  const HeldAttitude& held = *attitude_;
  const Eigen::Quaterniond q_WB = Eigen::AngleAxisd(held.yaw_rad, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(held.pitch_rad, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(held.roll_rad, Eigen::Vector3d::UnitX());
  io::SetAttitudeTarget message;
  message.time_boot_ms = static_cast<std::uint32_t>(t_ns / 1'000'000);
  message.q = {static_cast<float>(q_WB.w()), static_cast<float>(q_WB.x()),
               static_cast<float>(q_WB.y()), static_cast<float>(q_WB.z())};
  message.body_yaw_rate = static_cast<float>(held.yaw_rate_radps);
  message.thrust = static_cast<float>(held.thrust);
  message.target_system = message.target_component = kVehicle;
  message.type_mask = kAttitudeAndYawRate;
  const io::MavlinkFrame frame = io::pack(message, sender_);
  carry(frame, Awaited::target);
  send(t_ns, io::encode(frame));
  next_target_ns_ = t_ns + kAttitudePeriod_ns;
}

void Station::send_target(std::int64_t t_ns, const Send& send) {
  if (attitude_) return send_attitude(t_ns, send);
  io::SetPositionTargetLocalNed message;
  message.time_boot_ms = static_cast<std::uint32_t>(t_ns / 1'000'000);
  message.x = static_cast<float>(target_->p_W_m.x());
  message.y = static_cast<float>(target_->p_W_m.y());
  message.z = static_cast<float>(target_->p_W_m.z());
  message.yaw = static_cast<float>(target_->yaw_rad);
  message.type_mask = kPositionAndYaw;
  const auto put = [](const Eigen::Vector3d& from, float& x, float& y, float& z) {
    x = static_cast<float>(from.x());
    y = static_cast<float>(from.y());
    z = static_cast<float>(from.z());
  };
  if (path_) {
    const PathPoint point = path_(static_cast<double>(t_ns - path_start_ns_) * 1e-9);
    put(point.v_W_mps, message.vx, message.vy, message.vz);
    put(point.a_W_mps2, message.afx, message.afy, message.afz);
    message.type_mask = kPathPoint;
  } else if (cruise_W_mps_) {
    put(*cruise_W_mps_, message.vx, message.vy, message.vz);
    message.type_mask = kVelocityAtHeight;
  }
  message.target_system = message.target_component = kVehicle;
  message.coordinate_frame = kLocalNed;
  const io::MavlinkFrame frame = io::pack(message, sender_);
  carry(frame, Awaited::target);
  send(t_ns, io::encode(frame));
  next_target_ns_ = t_ns + kTargetPeriod_ns;
}

void Station::send_command(std::int64_t t_ns, const Send& send) {
  Pending& first = commands_.front();
  if (first.tries == kTries) {
    last_result_ = kUnanswered;
    commands_.pop_front();
    return;
  }
  first.message.confirmation = static_cast<std::uint8_t>(first.tries++);
  first.next_ns = t_ns + kRetry_ns;
  const io::MavlinkFrame frame = io::pack(first.message, sender_);
  if (first.newest) carry(frame, Awaited::command);
  send(t_ns, io::encode(frame));
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
  if (on_frame_) on_frame_(frame, heard_ns_);
  if (const auto beat = io::unpack<io::Heartbeat>(frame)) {
    telemetry_.state = beat->custom_mode;
    telemetry_.armed = (beat->base_mode & 0x80) != 0 ? 1.0 : 0.0;
    telemetry_.ready = beat->system_status == 3 ? 1.0 : 0.0;  // MAV_STATE_STANDBY
    heartbeat_ns_ = heard_ns_;
  } else if (const auto ack = io::unpack<io::CommandAck>(frame)) {
    acknowledged(*ack);
  } else if (const auto parameter = io::unpack<io::ParamValue>(frame)) {
    parameters_.on_value(*parameter);
  } else if (const auto position = io::unpack<io::LocalPositionNed>(frame)) {
    telemetry_.north_m = position->x;
    telemetry_.east_m = position->y;
    telemetry_.height_m = -position->z;
  } else if (const auto status = io::unpack<io::SysStatus>(frame)) {
    telemetry_.voltage_V = status->voltage_battery / 1000.0;
    telemetry_.current_A = status->current_battery / 100.0;
    telemetry_.load = status->load / 1000.0;
    constexpr std::uint32_t kLogging = 1u << 24;  // MAV_SYS_STATUS_LOGGING
    telemetry_.logging = (status->sensors_health & kLogging) != 0 ? 1.0 : 0.0;
  } else if (const auto attitude = io::unpack<io::AttitudeQuaternion>(frame)) {
    // cos(tilt) is the z-z element of the rotation: 1 - 2 (x^2 + y^2).
    const double x = attitude->q2, y = attitude->q3;
    telemetry_.tilt_rad = std::acos(std::clamp(1.0 - 2.0 * (x * x + y * y), -1.0, 1.0));
  } else if (const auto text = io::unpack<io::Statustext>(frame)) {
    texts_.push_back(text->string());
  }
}

Telemetry Station::telemetry(std::int64_t now_ns) const {
  Telemetry known = telemetry_;
  if (heartbeat_ns_ >= 0)
    known.heartbeat_age_s = static_cast<double>(now_ns - heartbeat_ns_) * 1e-9;
  // Three heartbeats missed: what the last one said is no news, and meets no limit.
  if (known.heartbeat_age_s > kOldNews_s) known.state = known.armed = known.ready = std::nan("");
  return known;
}

}  // namespace whirl::flight
