#include "harness/catalogue/stand_drive.hpp"

#include "harness/catalogue/calibration_file.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "harness/flight/controllers.hpp"

namespace whirl::catalogue {
Result<flight::FlightParams> read_stand_drive(const std::string& calibration,
                                              const std::string& propellers) {
  const auto file = read_calibration(calibration);
  if (!file) return file.error();
  const auto stand = read_stand(file.value().stand, propellers);
  if (!stand) return stand.error();
  flight::FlightParams drive;
  drive.name = "Thrust stand: " + plant::name(*stand.value().blade);
  drive.vehicle.motor = stand::motor_of(stand.value().stage);
  drive.vehicle.battery = stand.value().battery;
  drive.blade = stand.value().blade;
  drive.doubts = stand.value().doubts;
  drive.controller = flight::names_of(flight::controller_types()).front();
  if (const auto good = plant::validate(drive.vehicle.motor, calibration); !good) {
    return good.error();
  }
  return drive;
}

}  // namespace whirl::catalogue
