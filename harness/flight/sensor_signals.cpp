// The names of what the vehicle tells of its sensors, and of their calibration.
#include "harness/flight/flight_world.hpp"

namespace whirl::flight {

void FlightWorld::name_sensor_signals() {
  using D = Dimension;
  const auto told = [this]() -> const Told& { return estimates_.told(); };
  add_signal("heading_error", D::angle, "of the attitude that is flown by",
             [=] { return told().heading_error_rad; });
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string n = "_" + std::to_string(i + 1);
    add_signal("heading_error" + n, D::angle, "of the velocity-aided filter" + n,
               [=] { return told().filter_heading_error_rad[i]; });
  }
  const char* axes[] = {"x", "y", "z"};
  for (Eigen::Index i = 0; i < 3; ++i) {
    add_signal(std::string("accel_error_") + axes[i], D::acceleration,
               "what the vehicle tells (HIGHRES_IMU), less specific force in B",
               [=] { return told().accel_error_B_mps2[i]; });
    add_signal(std::string("gyro_error_") + axes[i], D::angular_rate, "likewise",
               [=] { return told().gyro_error_B_radps[i]; });
    add_signal(std::string("field_error_") + axes[i], D::magnetic_field,
               "likewise, less the earth's field and magnets",
               [=] { return told().field_error_B_T[i]; });
  }
  add_signal("calibration_result", D::none,
             "of the last { calibrate = ... }: MAV_RESULT of its latest COMMAND_ACK, -1 none yet",
             [=] { return told().calibration_result; });
  add_signal("calibration_progress", D::ratio, "in that answer",
             [=] { return told().calibration_progress; });
}

}  // namespace whirl::flight
