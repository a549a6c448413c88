#include "harness/catalogue/copies.hpp"

#include <algorithm>

#include "harness/catalogue/calibration_file.hpp"
#include "harness/catalogue/kind.hpp"
#include "harness/catalogue/motor_file.hpp"
#include "harness/catalogue/propeller_file.hpp"
#include "harness/catalogue/stand_drive.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "harness/catalogue/vehicle_file.hpp"
#include "harness/flight/vehicle_parts.hpp"
#include "harness/stand/stand_parts.hpp"
#include "plant/parts/esc_stand.hpp"
#include "plant/parts/vehicle.hpp"

namespace whirl::catalogue {
namespace {

using plant::PartNumber;
using plant::ToleranceClass;

// A file that wants perfect parts everywhere says nothing of copies.
void choose(plant::Tolerances& all, std::span<const char* const> groups,
            std::optional<ToleranceClass> wanted) {
  const bool drawn = std::any_of(all.begin(), all.end(), [](const auto& group) {
    return group.second != ToleranceClass::none;
  });
  if (!wanted && drawn) return;
  for (const char* group : groups) all[group] = wanted.value_or(ToleranceClass::typical);
}

void add_numbers(Copies& copies, std::span<const PartNumber> numbers) {
  for (const PartNumber& number : numbers) {
    if (copies.tolerance.count(number.group) > 0) copies.numbers.push_back(&number);
  }
}

Copies copies_of(flight::FlightParams params) {
  Copies copies{params.name, params.tolerance, {}, {}};
  add_numbers(copies, plant::each_motors_numbers());
  add_numbers(copies, plant::vehicles_numbers());
  copies.of_seed = [params = std::move(params)](std::uint64_t seed) {
    flight::FlightParams copy = params;
    flight::draw_parts(copy, seed);
    return copy.drawn;
  };
  return copies;
}

// The first motor and propeller of a vehicle that has no more.
flight::FlightParams alone(const std::string& name, const char* group,
                           std::optional<ToleranceClass> wanted) {
  flight::FlightParams params;
  params.name = name;
  params.vehicle.airframe.rotors.resize(1);
  params.tolerance[group] = wanted.value_or(ToleranceClass::typical);
  return params;
}

Result<Copies> copies_of_stand(const std::string& path, std::optional<ToleranceClass> wanted,
                               const std::string& propellers) {
  const auto drive = read_stand_drive(path, propellers);
  if (!drive) return drive.error();
  const auto file = read_calibration(path);
  if (!file) return file.error();
  auto stand = read_stand(file.value().stand, propellers);
  if (!stand) return stand.error();
  choose(stand.value().tolerance, plant::esc_stand_groups(), wanted);
  Copies copies{drive.value().name, stand.value().tolerance, {}, {}};
  add_numbers(copies, plant::esc_stand_numbers());
  copies.of_seed = [params = stand.value()](std::uint64_t seed) {
    stand::StandParams copy = params;
    // The board's nominal numbers count in what is flown, not in by how much a copy is off them.
    stand::draw_parts(copy, BoardDescription{}, seed);
    return copy.drawn;
  };
  return copies;
}

}  // namespace

Result<Copies> read_copies(const std::string& path, std::optional<ToleranceClass> tolerance,
                           const std::string& propellers) {
  const auto kind = read_kind(path);
  if (!kind) return kind.error();
  if (kind.value() == "calibration") return copies_of_stand(path, tolerance, propellers);
  if (kind.value() == "motor") {
    const auto motor = read_motor_file(path);
    if (!motor) return motor.error();
    return copies_of(alone(motor.value().name, "motors", tolerance));
  }
  if (kind.value() == "propeller") {
    const auto propeller = read_propeller_file(path);
    if (!propeller) return propeller.error();
    return copies_of(alone(plant::name(*propeller.value().blade), "rotors", tolerance));
  }
  if (kind.value() != "vehicle") return no_part(path);
  auto vehicle = read_vehicle(path);
  if (!vehicle) return vehicle.error();
  choose(vehicle.value().tolerance, plant::vehicle_groups(), tolerance);
  return copies_of(std::move(vehicle.value()));
}

}  // namespace whirl::catalogue
