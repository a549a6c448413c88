// What a vehicle's sensors tell: uavcan.equipment.ahrs and air_data.
//
//   Frame  the sensor's body: x forward, y right, z down
//   Units  SI; the magnetic field in gauss (the protocol's)
#pragma once
#include "io_bridges/protocols/dronecan/data_type.hpp"
#include "io_bridges/protocols/dronecan/fields.hpp"

namespace whirl::io::dronecan {

struct RawImu {
  static constexpr DataType kType{Kind::message, 1003, 0x8280632C40E574B5, 119, "ahrs.RawIMU"};
  std::uint64_t time_us = 0;         // 0: not known
  float integration_interval_s = 0;  // 0 or less: the integrals mean nothing
  std::array<float, 3> rate_radps{}, rate_integral_rad{};
  std::array<float, 3> acceleration_mps2{}, acceleration_integral_mps{};
  Bounded<float, 36> covariance{};

  template <typename F>
  void layout(F& f) {
    f.u_cut(time_us, 56);
    f.f32(integration_interval_s);
    f.f16(rate_radps);
    f.f32(rate_integral_rad);
    f.f16(acceleration_mps2);
    f.f32(acceleration_integral_mps);
    f.tail(covariance, 16, [&](float& value) { f.f16(value); });
  }
};

struct MagneticFieldStrength2 {
  static constexpr DataType kType{Kind::message, 1002, 0xB6AC0C442430297E, 25,
                                  "ahrs.MagneticFieldStrength2"};
  std::uint8_t sensor_id = 0;
  std::array<float, 3> field_Ga{};
  Bounded<float, 9> covariance{};

  template <typename F>
  void layout(F& f) {
    f.u(sensor_id, 8);
    f.f16(field_Ga);
    f.tail(covariance, 16, [&](float& value) { f.f16(value); });
  }
};

struct StaticPressure {
  static constexpr DataType kType{Kind::message, 1028, 0xCDC7C43412BDC89A, 6,
                                  "air_data.StaticPressure"};
  float pressure_Pa = 0, variance_Pa2 = 0;

  template <typename F>
  void layout(F& f) {
    f.f32(pressure_Pa);
    f.f16(variance_Pa2);
  }
};

struct StaticTemperature {
  static constexpr DataType kType{Kind::message, 1029, 0x49272A6477D96271, 4,
                                  "air_data.StaticTemperature"};
  float temperature_K = 0, variance_K2 = 0;

  template <typename F>
  void layout(F& f) {
    f.f16(temperature_K);
    f.f16(variance_K2);
  }
};

}  // namespace whirl::io::dronecan
