#include "harness/flight/estimates.hpp"

#include <algorithm>

namespace whirl::flight {
namespace {

constexpr std::int64_t kByte_ns = 173'611;  // ten bits at 57600 baud
constexpr std::size_t kFrameOverhead = 12;

double angle_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return a.angularDistance(b);
}

Eigen::Quaterniond quaternion(const float* wxyz) {
  return Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized();
}

Eigen::Vector3d vector(const float* xyz) {
  return {xyz[0], xyz[1], xyz[2]};
}

}  // namespace

void Estimates::remember(std::int64_t t_ns, const plant::VehicleState& truth) {
  newest_ms_ = t_ns / 1'000'000;
  moments_[static_cast<std::size_t>(newest_ms_) % kKept] = {truth.p_WB_W_m, truth.v_WB_W_mps,
                                                            truth.wind_W_mps, truth.q_WB};
}

const Estimates::Moment& Estimates::at(std::int64_t uptime_ns, std::size_t frame_bytes,
                                       std::int64_t t_ns) {
  const auto air_ns = static_cast<std::int64_t>(frame_bytes) * kByte_ns;
  start_ns_ = std::min(start_ns_, t_ns - air_ns - uptime_ns);
  const std::int64_t ms = (start_ns_ + uptime_ns) / 1'000'000;
  const std::int64_t oldest = std::max<std::int64_t>(0, newest_ms_ - std::int64_t{kKept} + 1);
  return moments_[static_cast<std::size_t>(std::clamp(ms, oldest, newest_ms_)) % kKept];
}

void Estimates::hear(const io::MavlinkFrame& frame, std::int64_t t_ns) {
  if (newest_ms_ < 0) return;
  const std::size_t bytes = frame.length + kFrameOverhead;
  if (const auto flown = io::unpack<io::AttitudeQuaternion>(frame)) {
    const Moment& then = at(std::int64_t{flown->time_boot_ms} * 1'000'000, bytes, t_ns);
    const float wxyz[] = {flown->q1, flown->q2, flown->q3, flown->q4};
    told_.attitude_error_rad = angle_rad(quaternion(wxyz), then.q_WB);
  } else if (const auto moved = io::unpack<io::LocalPositionNed>(frame)) {
    const Moment& then = at(std::int64_t{moved->time_boot_ms} * 1'000'000, bytes, t_ns);
    told_.v_WB_error_W_mps = Eigen::Vector3d(moved->vx, moved->vy, moved->vz) - then.v_W_mps;
  } else if (const auto array = io::unpack<io::DebugFloatArray>(frame)) {
    const auto uptime_ns = static_cast<std::int64_t>(array->time_usec) * 1000;
    const Moment& then = at(uptime_ns, bytes, t_ns);
    if (array->array_id == 1) return take_filters(*array, then);
    if (array->array_id != 2) return;
    for (std::size_t i = 0; i < 2; ++i) {
      told_.filter_error_rad[i] = angle_rad(quaternion(array->data.data() + 4 * i), then.q_WB);
    }
  }
}

void Estimates::take_filters(const io::DebugFloatArray& array, const Moment& then) {
  const float* data = array.data.data();
  told_.scale = {data[0], data[1]};
  told_.v_AB_B_mps = vector(data + 2);
  told_.v_AB_error_B_mps =
      told_.v_AB_B_mps - then.q_WB.conjugate() * (then.v_W_mps - then.wind_W_mps);
  told_.wind_W_mps = vector(data + 5);
  told_.wind_error_W_mps = told_.wind_W_mps - then.wind_W_mps;
  told_.baro_height_m = data[8];
  told_.baro_climb_mps = data[9];
  told_.baro_height_error_m = told_.baro_height_m + then.p_W_m.z();
  told_.baro_climb_error_mps = told_.baro_climb_mps + then.v_W_mps.z();
}

}  // namespace whirl::flight
