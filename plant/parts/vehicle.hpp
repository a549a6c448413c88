// What the parts of a vehicle are from copy to copy: a table, one line for each number, some of them drawn
// for each motor and rotor.
//
//   Names    as in esc_stand.hpp; of the body and the IMU those of VehicleParams and the board's mpu6000
//   Units    SI; `of_nominal`: shares by which the file's own number is off
//   IMU      its own draws stay in plant/sensors/imu.hpp: the numbers here are the standard deviations that it
//            draws from, a third of what [MPU6000] guarantees, two thirds of it in the worst class
//   ESCs     where boards are the ESCs, what they are from copy to copy is a stand's table (esc_stand.hpp), of which `escs`
//            chooses converter, dividers, shunt and bus; here that group has no number
//   Source   on each line
//   Left out the pack, propellers that flutter or are bent, arms that are not square
#pragma once
#include <span>

#include "plant/parts/part_number.hpp"

namespace whirl::plant {

std::span<const PartNumber> each_motors_numbers();  // of groups motors and rotors
std::span<const PartNumber> vehicles_numbers();     // of groups body, imu and clock
std::span<const char* const> vehicle_groups();

}  // namespace whirl::plant
