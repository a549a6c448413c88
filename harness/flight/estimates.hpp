// What the vehicle says it believes of its motion, and how wrong that was when it was believed.
//
//   In       truth at each step; telemetry frames with the time at which their last bit came
//   Time     a frame tells the vehicle's uptime; what lies between that and the run's time is the
//            least that any frame took, less its own bits. Kept to a millisecond or two
//   Out      last values and errors; NaN until something was told. An error stays as it was until the
//            next frame
//   Frames   HIGHRES_IMU: what the sensors say once they are corrected; COMMAND_ACK of a calibration;
//            ATTITUDE_QUATERNION, LOCAL_POSITION_NED: what is flown by; DEBUG_FLOAT_ARRAY 1 to 3 of the flight image:
//            the velocity-aided filters
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "io_bridges/protocols/mavlink_messages.hpp"
#include "plant/vehicle.hpp"

namespace whirl::flight {

inline constexpr std::uint16_t kPreflightCalibration = 241;  // MAV_CMD

struct Told {
  static constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  double attitude_error_rad = kNothing;                        // of what is flown by
  std::array<double, 2> filter_error_rad{kNothing, kNothing};  // of filters 1 and 2
  std::array<double, 2> scale{kNothing, kNothing};
  Eigen::Vector3d v_AB_B_mps = Eigen::Vector3d::Constant(kNothing);
  Eigen::Vector3d v_AB_error_B_mps = Eigen::Vector3d::Constant(kNothing);
  Eigen::Vector3d wind_W_mps = Eigen::Vector3d::Constant(kNothing);
  Eigen::Vector3d wind_error_W_mps = Eigen::Vector3d::Constant(kNothing);
  Eigen::Vector3d v_WB_error_W_mps = Eigen::Vector3d::Constant(kNothing);  // of what is flown by
  double baro_height_m = kNothing, baro_climb_mps = kNothing;
  double drag_spm = kNothing, drag_sigma_spm = kNothing;
  double velocity_source = kNothing;  // 0 none, 1 capture, 2 drag, 3 GPS
  double baro_height_error_m = kNothing, baro_climb_error_mps = kNothing;
  double heading_error_rad = kNothing;                                 // of what is flown by
  std::array<double, 2> filter_heading_error_rad{kNothing, kNothing};  // of filters 1 and 2
  Eigen::Vector3d accel_error_B_mps2 = Eigen::Vector3d::Constant(kNothing);
  Eigen::Vector3d gyro_error_B_radps = Eigen::Vector3d::Constant(kNothing);
  Eigen::Vector3d field_error_B_T = Eigen::Vector3d::Constant(kNothing);
  double calibration_result = -1.0;        // MAV_RESULT; -1: no answer yet
  double calibration_progress = kNothing;  // 0..1
};

class Estimates {
 public:
  // Each millisecond.
  void remember(std::int64_t t_ns, const plant::VehicleState& truth,
                const Eigen::Vector3d& field_W_T);
  void await_calibration();  // what is told from now on is of a new one
  void hear(const io::MavlinkFrame& frame, std::int64_t t_ns);
  const Told& told() const { return told_; }

 private:
  struct Moment {
    Eigen::Vector3d p_W_m, v_W_mps, wind_W_mps;
    Eigen::Quaterniond q_WB;
    Eigen::Vector3d f_B_mps2, w_B_radps, field_W_T;
  };
  static constexpr std::size_t kKept = 1024;  // milliseconds

  const Moment& at(std::int64_t uptime_ns, std::size_t frame_bytes, std::int64_t t_ns);
  void on_ack(const io::CommandAck& ack);
  void take_sensors(const io::HighresImu& told, const Moment& then);
  void take_filters(const io::DebugFloatArray& array, const Moment& then);

  std::array<Moment, kKept> moments_{};
  std::int64_t newest_ms_ = -1;
  std::int64_t start_ns_ = std::numeric_limits<std::int64_t>::max();  // of the vehicle's uptime
  Told told_;
};

}  // namespace whirl::flight
