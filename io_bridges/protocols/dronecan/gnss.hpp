// uavcan.equipment.gnss.Fix2.
//
//   Frame  velocities north, east, down; heights above the ellipsoid and above the sea
//   Units  degrees in 1e-8, heights in millimetres (the protocol's), velocities in m/s
#pragma once
#include "io_bridges/protocols/dronecan/data_type.hpp"
#include "io_bridges/protocols/dronecan/fields.hpp"

namespace whirl::io::dronecan {

struct EcefPositionVelocity {
  std::array<float, 3> velocity_mps{};
  std::array<std::int64_t, 3> position_mm{};
  Bounded<float, 36> covariance{};

  template <typename F>
  void layout(F& f) {
    f.f32(velocity_mps);
    for (std::int64_t& axis_mm : position_mm) f.i(axis_mm, 36);
    f.skip(6);
    f.tail(covariance, 16, [&](float& value) { f.f16(value); });
  }
};

struct Fix2 {
  static constexpr DataType kType{Kind::message, 1063, 0xCA41E7000F37435F, 221, "gnss.Fix2"};
  enum : std::uint8_t { no_fix, time_only, fix_2d, fix_3d };
  enum : std::uint8_t { no_time, tai, utc, gps };

  std::uint64_t time_us = 0, gnss_time_us = 0;
  std::uint8_t time_standard = no_time;
  std::uint8_t leap_seconds = 0;  // 0: not known
  std::int64_t longitude_1e8_deg = 0, latitude_1e8_deg = 0;
  std::int32_t height_ellipsoid_mm = 0, height_sea_mm = 0;
  std::array<float, 3> v_WB_W_mps{};
  std::uint8_t satellites = 0, status = no_fix;
  std::uint8_t mode = 0, sub_mode = 0;  // 0: single point
  Bounded<float, 36> covariance{};
  float pdop = 0;
  std::uint8_t ecef_count = 0;  // 0 or 1
  EcefPositionVelocity ecef{};

  template <typename F>
  void layout(F& f) {
    f.u_cut(time_us, 56);
    f.u_cut(gnss_time_us, 56);
    f.u(time_standard, 3);
    f.skip(13);
    f.u(leap_seconds, 8);
    f.i(longitude_1e8_deg, 37);
    f.i(latitude_1e8_deg, 37);
    f.i(height_ellipsoid_mm, 27);
    f.i(height_sea_mm, 27);
    f.f32(v_WB_W_mps);
    f.u(satellites, 6);
    f.u(status, 2);
    f.u(mode, 4);
    f.u(sub_mode, 6);
    f.array(covariance, 6, [&](float& value) { f.f16(value); });
    f.f16(pdop);
    if (f.is_there(ecef_count, 8)) ecef.layout(f);
  }
};

}  // namespace whirl::io::dronecan
