// Where a GNSS receiver finds itself: what the vehicle does, by the plant's errors, on a world that lies flat on the
// ellipsoid at a place of the board file's choice.
#pragma once
#include <cmath>
#include <vector>

#include "io_bridges/devices/ublox.hpp"
#include "io_bridges/rack/device_type.hpp"
#include "plant/sensors/gps.hpp"

namespace whirl::rack {

struct GnssPlace {
  plant::GpsParams physics;
  // Canberra, as the magnetic field of a flight.
  Geodetic origin{-35.28 * M_PI / 180.0, 149.13 * M_PI / 180.0, 600.0};
  double geoid_m = 19.0;
};

void add_place_keys(std::vector<DeviceKey>& keys);  // params.latitude, params.velocity_noise, ...
GnssPlace place_of(const DeviceSlot& slot);         // pre: the slot's type has those keys

class SensedPlace {
 public:
  SensedPlace(DeviceSlot& slot, const GnssPlace& place);

  void set(const io::BodyMotion& motion);
  // Tells the harness of it, too (gnss_solution).
  io::GnssFix fix(const io::Ublox::Query& query);

 private:
  void tell(Nanoseconds now, const io::GnssFix& fix, const std::array<double, 3>& p_m);

  plant::Gps gps_;
  plant::Truth truth_;
  Geodetic origin_;
  double geoid_m_;
  io::Batch& happened_;
  std::uint16_t number_;
};

}  // namespace whirl::rack
