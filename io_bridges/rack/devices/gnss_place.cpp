#include "io_bridges/rack/devices/gnss_place.hpp"

namespace whirl::rack {
namespace {

void add_world(std::vector<DeviceKey>& keys) {
  const GnssPlace usual;
  const auto angle = [](const char* path, double limit_deg, const char* about) {
    const double limit = limit_deg * M_PI / 180.0;
    return quantity_key(path, Dimension::angle, "deg", {-limit, limit}, about);
  };
  const auto metres = [](const char* path, const char* about) {
    return quantity_key(path, Dimension::length, "m", {-500.0, 10000.0}, about);
  };
  keys.push_back(
      angle("params.latitude", 90.0, "of the world's origin").with(usual.origin.latitude_rad));
  keys.push_back(angle("params.longitude", 180.0, "of the same").with(usual.origin.longitude_rad));
  keys.push_back(
      metres("params.height", "of the same, over the ellipsoid").with(usual.origin.height_m));
  keys.push_back(metres("params.geoid", "sea level over the ellipsoid").with(usual.geoid_m));
}

void add_error_keys(std::vector<DeviceKey>& keys) {
  const plant::GpsParams usual;
  const auto metres = [](const char* path, const char* about) {
    return quantity_key(path, Dimension::length, "m", {0.0, 1000.0}, about);
  };
  const auto speed = [](const char* path, const char* about) {
    return quantity_key(path, Dimension::speed, "m/s", {0.0, 100.0}, about);
  };
  keys.push_back(metres("params.wander_level", "standard deviation of position, north and east")
                     .with(usual.wander_level_m));
  keys.push_back(metres("params.wander_down", "and down").with(usual.wander_down_m));
  keys.push_back(
      quantity_key("params.wander_time", Dimension::time, "s", {0.1, 1e5}, "how slow it is")
          .with(usual.wander_time_s));
  keys.push_back(speed("params.velocity_noise", "standard deviation of velocity, north and east")
                     .with(usual.velocity_level_mps));
  keys.push_back(speed("params.velocity_noise_down", "and down").with(usual.velocity_down_mps));
}

}  // namespace

void add_place_keys(std::vector<DeviceKey>& keys) {
  add_world(keys);
  add_error_keys(keys);
}

GnssPlace place_of(const DeviceSlot& slot) {
  GnssPlace place;
  place.physics.wander_level_m = slot.quantity("params.wander_level");
  place.physics.wander_down_m = slot.quantity("params.wander_down");
  place.physics.wander_time_s = slot.quantity("params.wander_time");
  place.physics.velocity_level_mps = slot.quantity("params.velocity_noise");
  place.physics.velocity_down_mps = slot.quantity("params.velocity_noise_down");
  place.origin = {slot.quantity("params.latitude"), slot.quantity("params.longitude"),
                  slot.quantity("params.height")};
  place.geoid_m = slot.quantity("params.geoid");
  return place;
}

SensedPlace::SensedPlace(DeviceSlot& slot, const GnssPlace& place)
    : gps_(place.physics, slot.rack().seed(), slot.name()),
      origin_(place.origin),
      geoid_m_(place.geoid_m),
      happened_(slot.rack().happened()),
      number_(slot.number()) {}

void SensedPlace::set(const io::BodyMotion& motion) {
  for (int i = 0; i < 3; ++i) {
    truth_.p_WB_W_m[i] = motion.p_WB_W_m[i];
    truth_.v_WB_W_mps[i] = motion.v_WB_W_mps[i];
  }
}

io::GnssFix SensedPlace::fix(const io::Ublox::Query& query) {
  const plant::GpsFix seen =
      gps_.measure(static_cast<double>(query.now) * 1e-9, truth_, query.error_scale);
  std::array<double, 3> p_m{};
  io::GnssFix out;
  for (unsigned i = 0; i < 3; ++i) {
    p_m[i] = seen.p_WB_W_m[i] + query.offset_NED_m[i];
    out.v_NED_mps[i] = seen.v_WB_W_mps[i] + query.offset_NED_mps[i];
  }
  out.place = geodetic_of_ned(origin_, p_m);
  out.geoid_m = geoid_m_;
  out.level_accuracy_m = std::sqrt(2.0) * seen.level_accuracy_m;  // of two axes
  out.down_accuracy_m = seen.down_accuracy_m;
  out.velocity_accuracy_mps = std::sqrt(2.0) * seen.velocity_accuracy_mps;
  tell(query.now, out, p_m);
  return out;
}

void SensedPlace::tell(Nanoseconds now, const io::GnssFix& fix, const std::array<double, 3>& p_m) {
  io::GnssSolution told{.latitude_rad = fix.place.latitude_rad,
                        .longitude_rad = fix.place.longitude_rad,
                        .height_m = fix.place.height_m};
  for (unsigned i = 0; i < 3; ++i) {
    told.p_WB_W_m[i] = p_m[i];
    told.p_error_W_m[i] = p_m[i] - truth_.p_WB_W_m[i];
    told.v_error_W_mps[i] = fix.v_NED_mps[i] - truth_.v_WB_W_mps[i];
  }
  happened_.add(io::Kind::gnss_solution, number_, now, told);
}

}  // namespace whirl::rack
