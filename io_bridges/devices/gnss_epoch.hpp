// One solution of a GNSS receiver, before it is written as a message.
//
//   Frame   velocities north-east-down; heights over the WGS84 ellipsoid, and above the sea by the
//           geoid's height over the ellipsoid
#pragma once
#include <array>
#include <cstdint>

#include "base/wgs84.hpp"
#include "io_bridges/devices/gnss_time.hpp"

namespace whirl::io {

inline constexpr double kDeg_per_rad = 57.29577951308232;

struct GnssFix {  // what the receiver computes, its errors included
  Geodetic place;
  double geoid_m = 0.0;
  std::array<double, 3> v_NED_mps{};
  // Its own estimates of its errors, one standard deviation: level is that of the distance.
  double level_accuracy_m = 0.0, down_accuracy_m = 0.0, velocity_accuracy_mps = 0.0;
};

struct GnssEpoch {
  GpsTime time;
  UtcTime utc;
  bool time_known = false, fix = false;
  GnssFix at;  // without a fix: the last one that was
  int satellites = 0;
  double pdop = 99.99, hdop = 99.99, vdop = 99.99, tdop = 99.99;
  std::uint32_t first_fix_ms = 0;  // from the start to the first fix; 0: none yet
  std::uint32_t running_ms = 0;    // since the start
};

}  // namespace whirl::io
