#include "harness/catalogue/surroundings_table.hpp"

#include <cstdio>
#include <numbers>

#include "harness/catalogue/place_air.hpp"
#include "plant/airframe/contact_world.hpp"
#include "plant/sensors/magnetometer.hpp"

namespace whirl::catalogue {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using lua::above;
using lua::between;
using lua::Table;

constexpr double kPi = std::numbers::pi;
constexpr double kFarthest_m = 10e3, kFastest_mps = 100.0, kFastest_radps = 100.0;
constexpr double kMost_motor_radps = 5000.0;
constexpr double kSettled_m = 1e-3;  // Bullet's slop: so far gear may be in what it stands on
const char* const kIn_the_way = "feet, hubs or propellers would be in the floor or an obstacle";

// ---- Where

Vector3d read_size(const Table& t) {
  const auto size_m = t.quantities("size", Dimension::length, between(0.01, kFarthest_m));
  if (size_m.size() == 3) return {size_m[0], size_m[1], size_m[2]};
  t.refuse("size", "needs three lengths, along north, east and up");
  return Vector3d::Ones();
}

void read_room(const Table& t, flight::FlightParams& p) {
  const Vector3d size_m = read_size(t);
  const Vector3d half_m = 0.5 * size_m;
  p.capture.cameras.low_W_m = {-half_m.x(), -half_m.y(), -size_m.z()};
  p.capture.cameras.high_W_m = {half_m.x(), half_m.y(), 0.1};
  p.place.fence = flight::Fence{.half_size_m = half_m.head<2>(), .height_m = size_m.z()};
  if (!t.flag_or("solid", false)) return;
  auto& all = p.vehicle.obstacles;
  for (const double towards : {0.0, kPi}) all.push_back(plant::wall(half_m.x(), towards));
  for (const double towards : {0.5 * kPi, -0.5 * kPi}) {
    all.push_back(plant::wall(half_m.y(), towards));
  }
  all.push_back(plant::ceiling(size_m.z()));
}

// No cameras, and no fence of their making.
void go_outdoors(flight::FlightParams& p) {
  p.capture.cameras.low_W_m.setConstant(1.0);
  p.capture.cameras.high_W_m.setConstant(-1.0);
  p.place.fence.reset();
}

flight::Fence read_fence(const Table& t) {
  using Shape = flight::Fence::Shape;
  if (t.has("size")) {
    const Vector3d size_m = read_size(t);
    return {.half_size_m = 0.5 * size_m.head<2>(), .height_m = size_m.z()};
  }
  return {.shape = Shape::cylinder,
          .radius_m = t.quantity("radius", Dimension::length, above(0.0)),
          .height_m = t.quantity("height", Dimension::length, above(0.0))};
}

// ---- What stands there

plant::Obstacle read_obstacle(const Table& t) {
  const auto length = [&t](const char* key, double fallback_m) {
    return t.quantity_or(key, Dimension::length, fallback_m, between(-kFarthest_m, kFarthest_m));
  };
  const auto angle = [&t](const char* key) { return t.quantity_or(key, Dimension::angle, 0.0); };
  const std::string kind = t.choice("kind", {"box", "slope", "wall", "ceiling"});
  if (kind == "slope") {
    const double rise_rad = t.quantity("angle", Dimension::angle, between(0.0, 1.2));
    return plant::slope(length("north", 0.0), length("east", 0.0), angle("towards"), rise_rad);
  }
  if (kind == "wall") {
    return plant::wall(t.quantity("distance", Dimension::length, above(0.0)), angle("towards"));
  }
  if (kind == "ceiling") {
    return plant::ceiling(t.quantity("height", Dimension::length, above(0.0)));
  }
  return plant::box(length("north", 0.0), length("east", 0.0), length("base", 0.0), read_size(t),
                    angle("yaw"));
}

// ---- The earth's field and the air

Vector3d read_field(const Table& t) {
  constexpr double kMost_T = 200e-6;
  return plant::earth_field_W_T(
      t.quantity("strength", Dimension::magnetic_field, between(0.0, kMost_T)),
      t.quantity("inclination", Dimension::angle, between(-0.5 * kPi, 0.5 * kPi)),
      t.quantity("declination", Dimension::angle, between(-kPi, kPi)));
}

void read_air(const Table& t, plant::AirParams& air) {
  const auto wind_mps = [&t](const char* key) {
    return t.quantity_or(key, Dimension::speed, 0.0, between(-50.0, 50.0));
  };
  air.steady_wind_W_mps = {wind_mps("wind_north"), wind_mps("wind_east"), 0.0};
  air.dryden.wind_at_6m_mps =
      t.quantity_or("turbulence", Dimension::speed, 0.0, between(0.0, 50.0));
  const PlaceAir place = read_place_air(t);
  air.ground_height_m = place.above_sea_m;
  air.ground_temperature_offset_K = place.warmer_K;
  if (t.has("temperature_gradient")) {
    air.temperature_gradient_Kpm =
        t.quantity("temperature_gradient", Dimension::temperature_gradient, between(-0.2, 0.2));
  }
}

// ---- What hangs below

plant::SlungLoadParams read_load(const Table& t) {
  return {
      .mass_kg = t.quantity("mass", Dimension::mass, between(1e-3, 100.0)),
      .line_m = t.quantity("line", Dimension::length, between(0.05, 100.0)),
      .attach_B_m = {0.0, 0.0, t.quantity_or("below", Dimension::length, 0.0, between(-5.0, 5.0))},
      .drag_area_m2 = t.number_or("drag_area_m2", 0.0, between(0.0, 10.0))};
}

// ---- How it begins

Eigen::Quaterniond read_attitude(const Table& t) {
  const auto angle = [&t](const char* key) { return t.quantity_or(key, Dimension::angle, 0.0); };
  return AngleAxisd(angle("yaw"), Vector3d::UnitZ()) *
         AngleAxisd(angle("pitch"), Vector3d::UnitY()) *
         AngleAxisd(angle("roll"), Vector3d::UnitX());
}

bool stands_free(const plant::VehicleParams& v, const flight::Start& start) {
  return plant::stands_free(v.airframe, v.obstacles, start.p_WB_W_m, start.q_WB, kSettled_m);
}

// What the vehicle does by itself: on its gear at W's origin.
flight::Start standing(const plant::VehicleParams& v) {
  flight::Start start;
  start.p_WB_W_m.z() = plant::clearance_m(v.airframe, {}, Vector3d::Zero(), start.q_WB);
  return start;
}

flight::Start read_start(const Table& t, const plant::VehicleParams& vehicle) {
  const auto speed = [&t](const char* key) {
    return t.quantity_or(key, Dimension::speed, 0.0, between(-kFastest_mps, kFastest_mps));
  };
  const auto rate = [&t](const char* key) {
    return t.quantity_or(key, Dimension::angular_rate, 0.0,
                         between(-kFastest_radps, kFastest_radps));
  };
  const auto place = [&t](const char* key) {
    return t.quantity_or(key, Dimension::length, 0.0, between(-kFarthest_m, kFarthest_m));
  };
  flight::Start start;
  start.q_WB = read_attitude(t);
  const double standing_z_m =
      plant::clearance_m(vehicle.airframe, {}, Vector3d::Zero(), start.q_WB);
  start.p_WB_W_m = {place("north"), place("east"),
                    -t.quantity_or("height", Dimension::length, -standing_z_m,
                                   between(-kFarthest_m, kFarthest_m))};
  start.v_WB_W_mps = {speed("velocity_north"), speed("velocity_east"), -speed("climb")};
  start.w_WB_B_radps = {rate("rate_x"), rate("rate_y"), rate("rate_z")};
  start.motor_speed_radps = t.quantity_or("motor_speed", Dimension::angular_rate, 0.0,
                                          between(-kMost_motor_radps, kMost_motor_radps));
  if (!stands_free(vehicle, start)) {
    char lowest[80];
    std::snprintf(lowest, sizeof lowest, "clear of the floor in this attitude: from %.3f m up",
                  -standing_z_m);
    t.refuse(t.has("height") ? "height" : "north", kIn_the_way, lowest);
  }
  return start;
}

}  // namespace

Result<Done> read_surroundings(const Table& plan, flight::FlightParams& params) {
  const bool outdoors = plan.has("outdoors") && plan.flag_or("outdoors", false);
  if (outdoors && plan.has("room")) plan.refuse("room", "there is none outdoors");
  if (outdoors) go_outdoors(params);
  if (plan.has("room")) read_room(plan.table("room"), params);
  if (plan.has("fence")) params.place.fence = read_fence(plan.table("fence"));
  for (const Table& entry : plan.tables("obstacles")) {
    params.vehicle.obstacles.push_back(read_obstacle(entry));
  }
  if (plan.has("field")) params.place.magnetic_field_W_T = read_field(plan.table("field"));
  if (plan.has("air")) read_air(plan.table("air"), params.vehicle.air);
  if (plan.has("load")) {
    const Table load = plan.table("load");
    params.vehicle.load = read_load(load);
    const double standing_m = -standing(params.vehicle).p_WB_W_m.z();
    if (params.vehicle.load->attach_B_m.z() > standing_m) {
      load.refuse("below", "the line would begin below the floor where the vehicle stands");
    }
  }
  // A start is looked at only where all before it is sound.
  if (const auto good = plan.finish_except({"start"}); !good) return good.error();
  if (plan.has("start")) {
    params.place.start = read_start(plan.table("start"), params.vehicle);
  } else if (const auto& v = params.vehicle; !v.obstacles.empty() && !stands_free(v, standing(v))) {
    plan.refuse("start", kIn_the_way, "say where it starts");
  }
  return plan.finish();
}

}  // namespace whirl::catalogue
