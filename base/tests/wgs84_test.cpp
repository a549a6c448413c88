// Oracles: the ellipsoid's axes, and the radii of curvature M and N in closed form.
#include "base/wgs84.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"

namespace whirl {
namespace {

constexpr double kA = 6378137.0, kB = 6356752.314245;  // of WGS84, m; b as it is printed
constexpr double kDeg = M_PI / 180.0;

TEST(Wgs84, AxesOfTheEllipsoid) {
  EXPECT_EQ(ecef_m({0.0, 0.0, 0.0})[0], kA);
  EXPECT_TRUE(near(ecef_m({0.0, 90.0 * kDeg, 5.0})[1], kA + 5.0, round_off(2, kA)));
  EXPECT_TRUE(near(ecef_m({90.0 * kDeg, 0.0, 0.0})[2], kB, printed_to(1e-6)));
  EXPECT_TRUE(near(ecef_m({-90.0 * kDeg, 0.0, 1.0})[2], -kB - 1.0, printed_to(1e-6)));
}

TEST(Wgs84, ThereAndBackWithinAMicrometre) {
  for (int lat = -90; lat <= 90; lat += 15) {
    for (int lon = -165; lon <= 180; lon += 45) {
      for (const double h_m : {-400.0, 0.0, 600.0, 12000.0}) {
        const Geodetic back = geodetic_of_ecef(ecef_m({lat * kDeg, lon * kDeg, h_m}));
        EXPECT_TRUE(near(back.latitude_rad * kA, lat * kDeg * kA, stated(1e-6, "1 um"))) << lat;
        EXPECT_TRUE(near(back.height_m, h_m, stated(1e-6, "1 um"))) << lat;
        if (std::abs(lat) == 90) continue;  // a pole has every longitude
        EXPECT_TRUE(near(back.longitude_rad * kA, lon * kDeg * kA, stated(1e-6, "1 um"))) << lon;
      }
    }
  }
}

// M = a (1 - e^2) / (1 - e^2 sin^2)^1.5 along the meridian, N = a / sqrt(1 - e^2 sin^2) across it.
TEST(Wgs84, AShortWayTurnsByTheRadiusOfCurvature) {
  constexpr double kE2 = 6.69437999014e-3;  // as it is printed
  const Geodetic canberra{-35.28 * kDeg, 149.13 * kDeg, 580.0};
  const double s = std::sin(canberra.latitude_rad), w2 = 1.0 - kE2 * s * s;
  const double m = kA * (1.0 - kE2) / std::pow(w2, 1.5), n = kA / std::sqrt(w2);
  const Geodetic north = geodetic_of_ned(canberra, {10.0, 0.0, 0.0});
  const Geodetic east = geodetic_of_ned(canberra, {0.0, 10.0, 0.0});
  EXPECT_TRUE(near((north.latitude_rad - canberra.latitude_rad) * (m + 580.0), 10.0,
                   stated(1e-5, "curvature over 10 m")));
  EXPECT_TRUE(near(
      (east.longitude_rad - canberra.longitude_rad) * (n + 580.0) * std::cos(canberra.latitude_rad),
      10.0, stated(1e-5, "curvature over 10 m")));
  EXPECT_TRUE(
      near(geodetic_of_ned(canberra, {0.0, 0.0, -7.0}).height_m, 587.0, stated(1e-6, "1 um")));
}

TEST(Wgs84, TheFlatWorldLeavesTheGroundByDistanceSquaredOverTheDiameter) {
  const Geodetic far = geodetic_of_ned({}, {0.0, 1000.0, 0.0});
  EXPECT_TRUE(near(far.height_m, 1e6 / (2.0 * kA), stated(1e-4, "next term of the series")));
}

TEST(Wgs84, NorthAtTheEquatorIsAlongThePolesAxis) {
  const auto v = ned_in_ecef({0.0, 0.0, 0.0}, {1.0, 2.0, 3.0});
  EXPECT_EQ(v[0], -3.0);
  EXPECT_EQ(v[1], 2.0);
  EXPECT_EQ(v[2], 1.0);
}

}  // namespace
}  // namespace whirl
