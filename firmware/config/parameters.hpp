// The parameters of the flight image: what can be set over the radio and is kept in flash.
//
//   Table   one row each in kParameterTable, in the order of Parameter; to add one, add both lines.
//           The store knows them by their names: rows may move, a new name is a new parameter
//   Units   degrees and shares as a pilot types them; the last word of a name in the enumeration
//   Refused NaN, beyond the bounds, a fraction where whole numbers go, while armed where the row says
//           so: the old value stays
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "firmware/config/vehicle.hpp"

namespace fw {

enum class Parameter : std::uint8_t {
  est_filter,          // 0: explicit complementary filter, 1: velocity-aided filters
  est_start_scale,     // latent scale that the velocity-aided filters start with
  est_start_tilt_deg,  // about the nose, by which their attitude starts wrong; a change of either
                       // starts them anew, but not while they are flown by
  ctl_feedforward,     // 1: acceleration and rates of a trajectory are fed forward
  ctl_no_heading,  // 1: where a place is held, the attitude of appendix E: its heading goes where qd3
                   // is 0, near north
  mag_declination_deg,  // of the magnetic field, towards east of north
  fence_north_m,        // half the width of the box about the origin that is not left; 0: no limit
  fence_east_m,
  fence_top_m,     // its height over the origin
  fence_radius_m,  // the same by GPS alone: a cylinder about where it began
  fence_height_m,
  bat_resistance_ohm,  // of pack and leads: the voltage at rest is what is measured, and R I
  bat_low_V,           // at rest: lands, and does not arm
  bat_empty_V,         // at rest: lands at once
  aero_drag_spm,  // the rotors' drag over thrust and air speed; flights identify it and leave it
                  // here, a change by hand starts that anew
  // What calibrations have found (calibration/sensor_correction.hpp), along x, y, z of B.
  cal_gyro_x_radps,  // zero points
  cal_gyro_y_radps,
  cal_gyro_z_radps,
  cal_accel_x_mps2,
  cal_accel_y_mps2,
  cal_accel_z_mps2,
  cal_accel_scale_x,
  cal_accel_scale_y,
  cal_accel_scale_z,
  cal_mag_x_uT,  // hard iron
  cal_mag_y_uT,
  cal_mag_z_uT,
  cal_mag_scale_x,  // soft iron: a symmetric matrix
  cal_mag_scale_y,
  cal_mag_scale_z,
  cal_mag_xy,
  cal_mag_xz,
  cal_mag_yz,
  cal_motor_1x_uTpA,  // the field that each ampere of a motor's adds
  cal_motor_1y_uTpA,
  cal_motor_1z_uTpA,
  cal_motor_2x_uTpA,
  cal_motor_2y_uTpA,
  cal_motor_2z_uTpA,
  cal_motor_3x_uTpA,
  cal_motor_3y_uTpA,
  cal_motor_3z_uTpA,
  cal_motor_4x_uTpA,
  cal_motor_4y_uTpA,
  cal_motor_4z_uTpA,
  esc_bus,     // 0: the ESCs hang on I2C3, 1: on CAN2 (drivers/esc_can.hpp)
  sensor_bus,  // 0: the sensors are the board's, 1: nodes on CAN2 (drivers/can_sensors.hpp)
};

enum class Numbers : std::uint8_t { real, whole };
enum class WhileArmed : std::uint8_t { refused, allowed };

struct ParameterRow {
  Parameter parameter;
  std::string_view name;
  float start, low, high;  // start: its value until it was set
  Numbers numbers;
  WhileArmed while_armed;
};

inline constexpr ParameterRow kParameterTable[] = {
    {Parameter::est_filter, "EST_FILTER", 1, 0, 1, Numbers::whole, WhileArmed::refused},
    {Parameter::est_start_scale, "EST_START_SCALE", 1, 0.5f, 1.5f, Numbers::real,
     WhileArmed::allowed},
    {Parameter::est_start_tilt_deg, "EST_START_TILT", 0, -45, 45, Numbers::real,
     WhileArmed::allowed},
    {Parameter::ctl_feedforward, "CTL_FEEDFWD", 1, 0, 1, Numbers::whole, WhileArmed::allowed},
    {Parameter::ctl_no_heading, "CTL_NO_HEADING", 0, 0, 1, Numbers::whole, WhileArmed::refused},
    // Canberra, from a map.
    {Parameter::mag_declination_deg, "MAG_DECLINATION", 12.4f, -180, 180, Numbers::real,
     WhileArmed::refused},
    // The room of the thesis, 5 x 4 x 3 m.
    {Parameter::fence_north_m, "FENCE_NORTH", 2.5f, 0, 10'000, Numbers::real, WhileArmed::refused},
    {Parameter::fence_east_m, "FENCE_EAST", 2.0f, 0, 10'000, Numbers::real, WhileArmed::refused},
    {Parameter::fence_top_m, "FENCE_TOP", 3.0f, 0, 10'000, Numbers::real, WhileArmed::refused},
    {Parameter::fence_radius_m, "FENCE_RADIUS", 50, 0, 10'000, Numbers::real, WhileArmed::refused},
    {Parameter::fence_height_m, "FENCE_HEIGHT", 30, 0, 10'000, Numbers::real, WhileArmed::refused},
    // Four lithium-polymer cells: 3.6 V each at rest is some 15 % of the charge, 3.45 V some 5 %. A pack
    // of 2200 mAh has 8 to 15 mOhm by its discharge rating, its leads and plugs as much.
    {Parameter::bat_resistance_ohm, "BAT_RESISTANCE", 0.025f, 0, 1, Numbers::real,
     WhileArmed::allowed},
    {Parameter::bat_low_V, "BAT_LOW", 14.4f, 0, 60, Numbers::real, WhileArmed::refused},
    {Parameter::bat_empty_V, "BAT_EMPTY", 13.8f, 0, 60, Numbers::real, WhileArmed::refused},
    {Parameter::aero_drag_spm, "AERO_DRAG", config::kDrag_spm, 0.02f, 0.08f, Numbers::real,
     WhileArmed::refused},
    {Parameter::cal_gyro_x_radps, "CAL_GYR_XOFF", 0, -0.7f, 0.7f, Numbers::real,
     WhileArmed::refused},
    {Parameter::cal_gyro_y_radps, "CAL_GYR_YOFF", 0, -0.7f, 0.7f, Numbers::real,
     WhileArmed::refused},
    {Parameter::cal_gyro_z_radps, "CAL_GYR_ZOFF", 0, -0.7f, 0.7f, Numbers::real,
     WhileArmed::refused},
    {Parameter::cal_accel_x_mps2, "CAL_ACC_XOFF", 0, -1.5f, 1.5f, Numbers::real,
     WhileArmed::refused},
    {Parameter::cal_accel_y_mps2, "CAL_ACC_YOFF", 0, -1.5f, 1.5f, Numbers::real,
     WhileArmed::refused},
    {Parameter::cal_accel_z_mps2, "CAL_ACC_ZOFF", 0, -1.5f, 1.5f, Numbers::real,
     WhileArmed::refused},
    {Parameter::cal_accel_scale_x, "CAL_ACC_XSCALE", 1, 0.9f, 1.1f, Numbers::real,
     WhileArmed::refused},
    {Parameter::cal_accel_scale_y, "CAL_ACC_YSCALE", 1, 0.9f, 1.1f, Numbers::real,
     WhileArmed::refused},
    {Parameter::cal_accel_scale_z, "CAL_ACC_ZSCALE", 1, 0.9f, 1.1f, Numbers::real,
     WhileArmed::refused},
    {Parameter::cal_mag_x_uT, "CAL_MAG_XOFF", 0, -200, 200, Numbers::real, WhileArmed::refused},
    {Parameter::cal_mag_y_uT, "CAL_MAG_YOFF", 0, -200, 200, Numbers::real, WhileArmed::refused},
    {Parameter::cal_mag_z_uT, "CAL_MAG_ZOFF", 0, -200, 200, Numbers::real, WhileArmed::refused},
    {Parameter::cal_mag_scale_x, "CAL_MAG_XSCALE", 1, 0.5f, 1.5f, Numbers::real,
     WhileArmed::refused},
    {Parameter::cal_mag_scale_y, "CAL_MAG_YSCALE", 1, 0.5f, 1.5f, Numbers::real,
     WhileArmed::refused},
    {Parameter::cal_mag_scale_z, "CAL_MAG_ZSCALE", 1, 0.5f, 1.5f, Numbers::real,
     WhileArmed::refused},
    {Parameter::cal_mag_xy, "CAL_MAG_XY", 0, -0.5f, 0.5f, Numbers::real, WhileArmed::refused},
    {Parameter::cal_mag_xz, "CAL_MAG_XZ", 0, -0.5f, 0.5f, Numbers::real, WhileArmed::refused},
    {Parameter::cal_mag_yz, "CAL_MAG_YZ", 0, -0.5f, 0.5f, Numbers::real, WhileArmed::refused},
    {Parameter::cal_motor_1x_uTpA, "CAL_MAG_M1X", 0, -10, 10, Numbers::real, WhileArmed::refused},
    {Parameter::cal_motor_1y_uTpA, "CAL_MAG_M1Y", 0, -10, 10, Numbers::real, WhileArmed::refused},
    {Parameter::cal_motor_1z_uTpA, "CAL_MAG_M1Z", 0, -10, 10, Numbers::real, WhileArmed::refused},
    {Parameter::cal_motor_2x_uTpA, "CAL_MAG_M2X", 0, -10, 10, Numbers::real, WhileArmed::refused},
    {Parameter::cal_motor_2y_uTpA, "CAL_MAG_M2Y", 0, -10, 10, Numbers::real, WhileArmed::refused},
    {Parameter::cal_motor_2z_uTpA, "CAL_MAG_M2Z", 0, -10, 10, Numbers::real, WhileArmed::refused},
    {Parameter::cal_motor_3x_uTpA, "CAL_MAG_M3X", 0, -10, 10, Numbers::real, WhileArmed::refused},
    {Parameter::cal_motor_3y_uTpA, "CAL_MAG_M3Y", 0, -10, 10, Numbers::real, WhileArmed::refused},
    {Parameter::cal_motor_3z_uTpA, "CAL_MAG_M3Z", 0, -10, 10, Numbers::real, WhileArmed::refused},
    {Parameter::cal_motor_4x_uTpA, "CAL_MAG_M4X", 0, -10, 10, Numbers::real, WhileArmed::refused},
    {Parameter::cal_motor_4y_uTpA, "CAL_MAG_M4Y", 0, -10, 10, Numbers::real, WhileArmed::refused},
    {Parameter::cal_motor_4z_uTpA, "CAL_MAG_M4Z", 0, -10, 10, Numbers::real, WhileArmed::refused},
    {Parameter::esc_bus, "ESC_BUS", 0, 0, 1, Numbers::whole, WhileArmed::refused},
    {Parameter::sensor_bus, "SENS_BUS", 0, 0, 1, Numbers::whole, WhileArmed::refused},
};
inline constexpr std::size_t kParameterCount = std::size(kParameterTable);

class Parameters {
 public:
  Parameters();

  float get(Parameter parameter) const { return values_[static_cast<std::size_t>(parameter)]; }
  bool is_on(Parameter parameter) const { return get(parameter) != 0.0f; }

  float value(std::size_t index) const { return values_[index]; }
  // False: refused, and nothing has changed.
  bool set(std::size_t index, float value, bool armed);
  bool set(Parameter parameter, float value) {
    return set(static_cast<std::size_t>(parameter), value, false);
  }
  static std::optional<std::size_t> index_of(std::string_view name);

  std::uint32_t changes() const { return changes_; }  // counts up with each that was taken over

 private:
  std::array<float, kParameterCount> values_;
  std::uint32_t changes_ = 0;
};

}  // namespace fw
