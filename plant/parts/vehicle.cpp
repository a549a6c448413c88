#include "plant/parts/vehicle.hpp"

#include "base/angles.hpp"
#include "plant/parts/motor_numbers.hpp"

namespace whirl::plant {
namespace {

using Law = Spread::Law;

constexpr double kG_mps2 = 9.80665;

constexpr const char* kVehicleGroups[] = {"motors", "rotors", "body", "imu", "clock", "escs"};

constexpr PartNumber kEach[] = {
    parts::torque_constant("motors"),
    parts::resistance("motors"),
    parts::no_load_current("motors"),
    parts::inertia("motors"),
    parts::heat_capacity("motors"),
    parts::bearing_share("motors"),
    {"rotors",
     "thrust",
     "",
     false,
     {Law::normal, 0.0, 0.015, 0.04},
     "estimate: pitch of moulded propellers within 0.3 degrees, chord within 1 %"},
    {"rotors", "torque", "", false, {Law::normal, 0.0, 0.02, 0.05}, "the same"},
    {"rotors",
     "unbalance",
     "kg m",
     false,
     {Law::level, 3e-7, 2e-7, 1e-6},
     "what a magnetic balancer leaves is 1e-7; worst: as it comes out of the bag"},
};

constexpr PartNumber kVehicle[] = {
    {"body", "mass", "", true, {Law::normal, 0.0, 0.003, 0.01}, "kitchen scale, and a new strap"},
    {"body", "inertia.x", "", true, {Law::normal, 0.0, 0.03, 0.08}, "bifilar pendulum: 3 %"},
    {"body", "inertia.y", "", true, {Law::normal, 0.0, 0.03, 0.08}, "bifilar pendulum: 3 %"},
    {"body", "inertia.z", "", true, {Law::normal, 0.0, 0.03, 0.08}, "bifilar pendulum: 3 %"},
    {"body", "centre.x", "m", false, {Law::normal, 0.0, 2e-3, 5e-3}, "balanced on two fingers"},
    {"body", "centre.y", "m", false, {Law::normal, 0.0, 2e-3, 5e-3}, "balanced on two fingers"},
    {"imu", "place.x", "m", false, {Law::normal, 0.0, 5e-3, 1.5e-2}, "measured by ruler"},
    {"imu", "place.y", "m", false, {Law::normal, 0.0, 5e-3, 1.5e-2}, "measured by ruler"},
    {"imu", "place.z", "m", false, {Law::normal, 0.0, 5e-3, 1.5e-2}, "measured by ruler"},
    {"imu",
     "misalignment.x",
     "rad",
     false,
     {Law::normal, 0.0, 0.3 * kDeg, 1.0 * kDeg},
     "a board on foam pads"},
    {"imu",
     "misalignment.y",
     "rad",
     false,
     {Law::normal, 0.0, 0.3 * kDeg, 1.0 * kDeg},
     "a board on foam pads"},
    {"imu",
     "misalignment.z",
     "rad",
     false,
     {Law::normal, 0.0, 0.3 * kDeg, 1.0 * kDeg},
     "a board on foam pads"},
    {"imu",
     "accelerometer.turn_on_bias",
     "m/s2",
     false,
     {Law::level, 0.06 * kG_mps2 / 3.0, 0.0, 0.06 * kG_mps2 / 3.0},
     "[MPU6000] 6.2: 50 mg along x and y, 80 mg along z; a third of their mean"},
    {"imu",
     "gyroscope.turn_on_bias",
     "rad/s",
     false,
     {Law::level, 20.0 * kDeg / 3.0, 0.0, 20.0 * kDeg / 3.0},
     "[MPU6000] 6.1: 20 deg/s"},
    {"imu",
     "accelerometer.scale_error",
     "",
     false,
     {Law::level, 0.01, 0.0, 0.01},
     "[MPU6000] 6.2: 3 %"},
    {"imu",
     "gyroscope.scale_error",
     "",
     false,
     {Law::level, 0.01, 0.0, 0.01},
     "[MPU6000] 6.1: 3 %"},
    {"imu",
     "accelerometer.cross_axis",
     "",
     false,
     {Law::level, 0.02 / 3.0, 0.0, 0.02 / 3.0},
     "[MPU6000] 6.2: 2 %"},
    {"imu",
     "gyroscope.cross_axis",
     "",
     false,
     {Law::level, 0.02 / 3.0, 0.0, 0.02 / 3.0},
     "[MPU6000] 6.1: 2 %"},
    parts::hse_error("clock"),
};

}  // namespace

std::span<const PartNumber> each_motors_numbers() {
  return kEach;
}

std::span<const PartNumber> vehicles_numbers() {
  return kVehicle;
}

std::span<const char* const> vehicle_groups() {
  return kVehicleGroups;
}

}  // namespace whirl::plant
