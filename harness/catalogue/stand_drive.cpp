#include "harness/catalogue/stand_drive.hpp"

#include <map>

#include "harness/catalogue/calibration_file.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "harness/flight/controllers.hpp"

namespace whirl::catalogue {
namespace {

plant::MotorParams motor_of(const stand::StageParams& stage) {
  plant::MotorParams motor;
  const std::map<std::string, double plant::MotorParams::*> places = {
      {"torque_constant", &plant::MotorParams::torque_constant_NmpA},
      {"resistance", &plant::MotorParams::resistance_ohm},
      {"inductance", &plant::MotorParams::inductance_H},
      {"no_load_current", &plant::MotorParams::no_load_current_A},
      {"inertia", &plant::MotorParams::inertia_kgm2}};
  for (const auto& [name, value] : stage) {
    if (const auto place = places.find(name); place != places.end()) motor.*place->second = value;
  }
  motor.winding_resistance_ohm = std::min(motor.winding_resistance_ohm, motor.resistance_ohm);
  return motor;
}

}  // namespace

Result<flight::FlightParams> read_stand_drive(const std::string& calibration,
                                              const std::string& propellers) {
  const auto file = read_calibration(calibration);
  if (!file) return file.error();
  const auto stand = read_stand(file.value().stand, propellers);
  if (!stand) return stand.error();
  flight::FlightParams drive;
  drive.name = "Thrust stand: " + plant::name(*stand.value().blade);
  drive.vehicle.motor = motor_of(stand.value().stage);
  drive.vehicle.battery = stand.value().battery;
  drive.blade = stand.value().blade;
  drive.controller = flight::names_of(flight::controller_types()).front();
  if (const auto good = plant::validate(drive.vehicle.motor, calibration); !good) {
    return good.error();
  }
  return drive;
}

}  // namespace whirl::catalogue
