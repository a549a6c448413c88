// A receiver's solutions at places around a point of the ellipsoid, from its printed series: no constant of
// the firmware's frame.
#pragma once
#include <Eigen/Dense>
#include <cmath>

#include "firmware/estimation/gps_frame.hpp"

namespace fw::test {

inline constexpr double kLatitude_deg = -35.28, kLongitude_deg = 149.13, kHeight_m = 600.0;
inline constexpr double kRad = M_PI / 180.0;

// Length of a degree on WGS84, m: the series of the US National Geospatial-Intelligence Agency.
inline double degree_north_m(double latitude_deg) {
  const double f = kRad * latitude_deg;
  return 111132.92 - 559.82 * std::cos(2 * f) + 1.175 * std::cos(4 * f) - 0.0023 * std::cos(6 * f);
}
inline double degree_east_m(double latitude_deg) {
  const double f = kRad * latitude_deg;
  return 111412.84 * std::cos(f) - 93.5 * std::cos(3 * f) + 0.118 * std::cos(5 * f);
}

inline GpsSolution solution_at(const Eigen::Vector3d& p_W_m, const Eigen::Vector3d& v_W_mps) {
  GpsSolution s;
  s.latitude_e7_deg = static_cast<std::int32_t>(
      std::lround(1e7 * (kLatitude_deg + p_W_m.x() / degree_north_m(kLatitude_deg))));
  s.longitude_e7_deg = static_cast<std::int32_t>(
      std::lround(1e7 * (kLongitude_deg + p_W_m.y() / degree_east_m(kLatitude_deg))));
  s.height_mm = static_cast<std::int32_t>(std::lround(1e3 * (kHeight_m - p_W_m.z())));
  s.v_W_mps = v_W_mps.cast<float>();
  s.level_accuracy_m = 3.0f;
  s.down_accuracy_m = 4.5f;
  s.speed_accuracy_mps = 0.12f;
  s.fix_type = 3;
  s.satellites = 9;
  s.within_limits = true;
  s.age_s = 0.11f;
  return s;
}

}  // namespace fw::test
