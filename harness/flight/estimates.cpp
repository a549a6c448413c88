#include "harness/flight/estimates.hpp"

#include <algorithm>
#include <cmath>

#include "harness/flight/capture.hpp"

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

double heading_error_rad(const Eigen::Quaterniond& told, const Eigen::Quaterniond& truth) {
  const double off_rad = roll_pitch_yaw_rad(told).z() - roll_pitch_yaw_rad(truth).z();
  return std::remainder(off_rad, 2.0 * M_PI);
}

Eigen::Vector3d vector(const float* xyz) {
  return {xyz[0], xyz[1], xyz[2]};
}

}  // namespace

void Estimates::remember(std::int64_t t_ns, const plant::VehicleState& truth,
                         const Eigen::Vector3d& field_W_T) {
  newest_ms_ = t_ns / 1'000'000;
  moments_[static_cast<std::size_t>(newest_ms_) % kKept] = {truth.p_WB_W_m,
                                                            truth.v_WB_W_mps,
                                                            truth.wind_W_mps,
                                                            truth.q_WB,
                                                            truth.specific_force_B_mps2,
                                                            truth.w_WB_B_radps,
                                                            field_W_T};
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
    told_.heading_error_rad = heading_error_rad(quaternion(wxyz), then.q_WB);
  } else if (const auto moved = io::unpack<io::LocalPositionNed>(frame)) {
    const Moment& then = at(std::int64_t{moved->time_boot_ms} * 1'000'000, bytes, t_ns);
    told_.v_WB_error_W_mps = Eigen::Vector3d(moved->vx, moved->vy, moved->vz) - then.v_W_mps;
  } else if (const auto sensors = io::unpack<io::HighresImu>(frame)) {
    const auto uptime_ns = static_cast<std::int64_t>(sensors->time_usec) * 1000;
    take_sensors(*sensors, at(uptime_ns, bytes, t_ns));
  } else if (const auto ack = io::unpack<io::CommandAck>(frame)) {
    on_ack(*ack);
  } else if (const auto array = io::unpack<io::DebugFloatArray>(frame)) {
    const auto uptime_ns = static_cast<std::int64_t>(array->time_usec) * 1000;
    const Moment& then = at(uptime_ns, bytes, t_ns);
    if (array->array_id == 1) return take_filters(*array, then);
    if (array->array_id == 3) {
      told_.drag_spm = array->data[0];
      told_.drag_sigma_spm = array->data[1];
      told_.velocity_source = array->data[2];
    }
    if (array->array_id != 2) return;
    for (std::size_t i = 0; i < 2; ++i) {
      const Eigen::Quaterniond q_WB = quaternion(array->data.data() + 4 * i);
      told_.filter_error_rad[i] = angle_rad(q_WB, then.q_WB);
      told_.filter_heading_error_rad[i] = heading_error_rad(q_WB, then.q_WB);
    }
  }
}

void Estimates::await_calibration() {
  told_.calibration_result = -1.0;
  told_.calibration_progress = Told::kNothing;
}

void Estimates::on_ack(const io::CommandAck& ack) {
  if (ack.command != kPreflightCalibration) return;
  told_.calibration_result = ack.result;
  told_.calibration_progress = 0.01 * ack.progress;
}

void Estimates::take_sensors(const io::HighresImu& told, const Moment& then) {
  constexpr double kGauss_T = 1e-4;
  constexpr std::uint16_t kField = 0x01C0;  // HIGHRES_IMU_UPDATED
  told_.accel_error_B_mps2 = Eigen::Vector3d(told.xacc, told.yacc, told.zacc) - then.f_B_mps2;
  told_.gyro_error_B_radps = Eigen::Vector3d(told.xgyro, told.ygyro, told.zgyro) - then.w_B_radps;
  if ((told.fields_updated & kField) == 0) return;
  told_.field_error_B_T = kGauss_T * Eigen::Vector3d(told.xmag, told.ymag, told.zmag) -
                          then.q_WB.conjugate() * then.field_W_T;
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
