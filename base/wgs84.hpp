// Places on the earth: geodetic latitude, longitude and height over the WGS84 ellipsoid, earth-centred
// coordinates, and a flat world that touches the ellipsoid in its origin.
//
//   Frame   ECEF: x through latitude 0, longitude 0, z through the north pole. The flat world is
//           north-east-down in its origin: its height departs from the ellipsoid's by d^2 / (2 a), 8 cm
//           in a distance d of 1 km, and that is carried over exactly
//   Valid   heights from -10 km to 1000 km
//   Source  WGS84 [NIMA TR8350.2]: a = 6378137 m, 1/f = 298.257223563; latitude by Bowring's formula
//           (1976), repeated
//   Error   there and back within 1 um (tests/wgs84_test.cpp)
#pragma once
#include <array>

namespace whirl {

struct Geodetic {
  double latitude_rad = 0.0, longitude_rad = 0.0;
  double height_m = 0.0;  // over the ellipsoid
};

std::array<double, 3> ecef_m(const Geodetic& place);
Geodetic geodetic_of_ecef(const std::array<double, 3>& p_m);

// The place that lies so far north, east and down of the origin in the flat world.
Geodetic geodetic_of_ned(const Geodetic& origin, const std::array<double, 3>& p_NED_m);
// Components along ECEF of a vector that is given along north, east, down in that place.
std::array<double, 3> ned_in_ecef(const Geodetic& place, const std::array<double, 3>& v_NED);

}  // namespace whirl
