#include "base/wgs84.hpp"

#include <cmath>

namespace whirl {
namespace {

constexpr double kA_m = 6378137.0, kF = 1.0 / 298.257223563;
constexpr double kB_m = kA_m * (1.0 - kF);
constexpr double kE2 = kF * (2.0 - kF);           // first eccentricity, squared
constexpr double kE2_second = kE2 / (1.0 - kE2);  // second eccentricity, squared

double normal_radius_m(double latitude_rad) {
  const double s = std::sin(latitude_rad);
  return kA_m / std::sqrt(1.0 - kE2 * s * s);
}

}  // namespace

std::array<double, 3> ecef_m(const Geodetic& p) {
  const double n_m = normal_radius_m(p.latitude_rad);
  const double across_m = (n_m + p.height_m) * std::cos(p.latitude_rad);
  return {across_m * std::cos(p.longitude_rad), across_m * std::sin(p.longitude_rad),
          (n_m * (1.0 - kE2) + p.height_m) * std::sin(p.latitude_rad)};
}

Geodetic geodetic_of_ecef(const std::array<double, 3>& p_m) {
  const double across_m = std::hypot(p_m[0], p_m[1]);
  double reduced_rad = std::atan2(kA_m * p_m[2], kB_m * across_m);
  double latitude_rad = 0.0;
  for (int k = 0; k < 4; ++k) {
    const double s = std::sin(reduced_rad), c = std::cos(reduced_rad);
    latitude_rad =
        std::atan2(p_m[2] + kE2_second * kB_m * s * s * s, across_m - kE2 * kA_m * c * c * c);
    reduced_rad = std::atan2(kB_m * std::sin(latitude_rad), kA_m * std::cos(latitude_rad));
  }
  const double n_m = normal_radius_m(latitude_rad);
  // The larger of the two components tells the height: the other vanishes at a pole or the equator.
  const bool polar = std::abs(std::sin(latitude_rad)) > 0.7;
  const double height_m = polar ? p_m[2] / std::sin(latitude_rad) - n_m * (1.0 - kE2)
                                : across_m / std::cos(latitude_rad) - n_m;
  return {latitude_rad, std::atan2(p_m[1], p_m[0]), height_m};
}

std::array<double, 3> ned_in_ecef(const Geodetic& place, const std::array<double, 3>& v) {
  const double sp = std::sin(place.latitude_rad), cp = std::cos(place.latitude_rad);
  const double sl = std::sin(place.longitude_rad), cl = std::cos(place.longitude_rad);
  return {-sp * cl * v[0] - sl * v[1] - cp * cl * v[2],
          -sp * sl * v[0] + cl * v[1] - cp * sl * v[2], cp * v[0] - sp * v[2]};
}

Geodetic geodetic_of_ned(const Geodetic& origin, const std::array<double, 3>& p_NED_m) {
  std::array<double, 3> p_m = ecef_m(origin);
  const std::array<double, 3> step_m = ned_in_ecef(origin, p_NED_m);
  for (unsigned i = 0; i < 3; ++i) p_m[i] += step_m[i];
  return geodetic_of_ecef(p_m);
}

}  // namespace whirl
