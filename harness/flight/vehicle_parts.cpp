#include "harness/flight/vehicle_parts.hpp"

#include <functional>

#include "base/check.hpp"
#include "io_bridges/board_description/pod_host.hpp"
#include "plant/parts/vehicle.hpp"

namespace whirl::flight {
namespace {

using plant::PartNumber;

using Use = std::function<void(const std::string& name, double value)>;

// `owner` is part of the stream and of what is told: "motor 2".
void draw(const FlightParams& params, std::span<const PartNumber> numbers, const std::string& owner,
          std::uint64_t seed, std::vector<DrawnPart>& drawn, const Use& use) {
  for (const PartNumber& part : numbers) {
    const std::string name = part.name, told = owner.empty() ? name : owner + " " + name;
    const auto value = plant::draw(part, params.tolerance, seed, "part." + told);
    if (!value) continue;
    drawn.push_back({told, *value, part.unit});
    use(name, *value);
  }
}

void use_of_motor(const std::string& name, double value, plant::MotorParams& motor,
                  plant::RotorMount& rotor) {
  if (name == "torque_constant") motor.torque_constant_NmpA *= 1.0 + value;
  if (name == "resistance") motor.resistance_ohm *= 1.0 + value;
  if (name == "no_load_current") motor.no_load_current_A *= 1.0 + value;
  if (name == "inertia") motor.inertia_kgm2 *= 1.0 + value;
  if (name == "heat_capacity") motor.heat_capacity_JpK = value;
  if (name == "bearing_share") motor.bearing_share = value;
  if (name == "thrust") rotor.thrust_error = value;
  if (name == "torque") rotor.torque_error = value;
  if (name == "unbalance") rotor.unbalance_kgm += value;
}

// "inertia.y" of `group` "inertia": 1; other names: -1.
int axis_of(const std::string& name, const std::string& group) {
  if (name.size() != group.size() + 2 || name.rfind(group + ".", 0) != 0) return -1;
  return name.back() - 'x';
}

void move_centre(plant::AirframeParams& airframe, const Eigen::Vector3d& to_B_m) {
  for (plant::RotorMount& rotor : airframe.rotors) rotor.p_BP_B_m -= to_B_m;
  for (Eigen::Vector3d& foot : airframe.contact.gear_B_m) foot -= to_B_m;
}

// Whether the board's ESCs on CAN take speeds is the file's, and no copy's.
void set_esc_mode(BoardDescription& board, const FlightParams& params) {
  if (params.esc.calibration.mode != fw::esc::Mode::speed) return;
  for (BoardDevice& device : board.devices) {
    if (device.type == "esc_dronecan") device.set("params.speeds", true);
  }
}

}  // namespace

void draw_parts(FlightParams& params, std::uint64_t seed) {
  plant::AirframeParams& airframe = params.vehicle.airframe;
  std::vector<plant::MotorParams> motors(airframe.rotors.size(), params.vehicle.motor);
  for (std::size_t i = 0; i < motors.size(); ++i) {
    draw(params, plant::each_motors_numbers(), "motor " + std::to_string(i + 1), seed, params.drawn,
         [&](const std::string& name, double value) {
           use_of_motor(name, value, motors[i], airframe.rotors[i]);
         });
  }
  if (!params.drawn.empty()) params.vehicle.motors = std::move(motors);
  Eigen::Vector3d centre_B_m = Eigen::Vector3d::Zero();
  draw(params, plant::vehicles_numbers(), "", seed, params.drawn,
       [&](const std::string& name, double value) {
         if (name == "mass") airframe.mass_kg *= 1.0 + value;
         if (name == "hse_error") params.hse_error = value;
         if (const int k = axis_of(name, "inertia"); k >= 0)
           airframe.inertia_kgm2[k] *= 1.0 + value;
         if (const int k = axis_of(name, "centre"); k >= 0) centre_B_m[k] = value;
         if (const int k = axis_of(name, "place"); k >= 0) params.imu_place_m[k] += value;
         if (const int k = axis_of(name, "misalignment"); k >= 0) params.imu_turn_rad[k] = value;
         if (name.find("meter.") != std::string::npos || name.find("scope.") != std::string::npos) {
           params.imu["params." + name] = value;
         }
       });
  move_centre(airframe, centre_B_m);
  params.imu_place_m -= centre_B_m;
}

void set_parts(BoardDescription& board, const FlightParams& params) {
  board.hse_error += params.hse_error;
  const auto add = [](BoardDevice& device, const char* key, const Eigen::Vector3d& more) {
    if (more.isZero(0.0)) return;
    std::vector<double> all(3, 0.0);
    if (const auto given = device.value(key);
        given && std::holds_alternative<std::vector<double>>(*given)) {
      all = std::get<std::vector<double>>(*given);
    }
    for (std::size_t k = 0; k < 3; ++k) all.at(k) += more[static_cast<Eigen::Index>(k)];
    WHIRL_CHECK(device.set(key, all), key);
  };
  set_esc_mode(board, params);
  for (BoardDevice& device : board.devices) {
    // On SPI, as a node of a CAN bus, or played by a pod.
    if (!device.type.starts_with("mpu6000") && !is_pod_host(device)) continue;
    for (const auto& [key, value] : params.imu) {
      if (!device.value(key)) WHIRL_CHECK(device.set(key, value), key);
    }
    add(device, "params.place", params.imu_place_m);
    add(device, "params.misalignment", params.imu_turn_rad);
  }
}

}  // namespace whirl::flight
