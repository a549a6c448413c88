// Ten minutes of hover on one pack.
#include <algorithm>
#include <cmath>

#include "plant/power_bus.hpp"
#include "plant/rotor/rotor.hpp"
#include "plant/validation/validation.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {
namespace {

constexpr double kDischargeStep_s = 0.01, kFastStep_s = 2.5e-4, kHover_N = 0.9 * 9.80665 / 4.0;

double hover_speed(const Rotor& rotor, RotorLoads& loads) {
  double low = 200.0, high = 700.0;
  for (int k = 0; k < 40; ++k) {
    RotorConditions c;
    c.omega_radps = 0.5 * (low + high);
    loads = rotor.steady(c);
    (loads.thrust_N < kHover_N ? low : high) = c.omega_radps;
  }
  return low;
}

}  // namespace

std::vector<Proof> battery_proofs(const std::shared_ptr<const Blade>& blade) {
  RotorLoads loads;
  const double omega = hover_speed(Rotor(blade, 1), loads);
  const VehicleParams vehicle = hp_quad();
  std::vector<AveragedMotor> motors(4, AveragedMotor(vehicle.motor));
  for (auto& motor : motors) motor.set_speed(omega);
  std::array<Drive, 4> drives;
  std::array<ShaftLoad, 4> load;
  load.fill({loads.shaft_torque_Nm / (omega * omega), 0.0});
  std::array<MotorBooks, 4> books;
  Battery pack(vehicle.battery);
  Curve curve{"bus voltage", {}, {}};
  double duty = 0.3, least_A = 1e9, most_A = 0.0, bus_V = 0.0;
  for (int k = 0; k < 60000; ++k) {
    duty += 2e-4 * (omega - motors[0].speed_radps()) * kDischargeStep_s;  // holds hover's speed
    for (auto& drive : drives) drive.duty = std::clamp(duty, 0.0, 1.0);
    double charge = 0.0;
    // Quasi-steady: a few electrical time constants stand for the whole step.
    for (int i = 0; i < 4; ++i) {
      bus_V = step_bus(motors, drives, load, vehicle.avionics_current_A, pack, kFastStep_s, books)
                  .bus_V;
      charge += books[0].bus_charge_C;
    }
    double drawn_A = vehicle.avionics_current_A;
    for (const auto& b : books) drawn_A += b.bus_charge_C / kFastStep_s;
    pack.draw(drawn_A * (kDischargeStep_s - 4 * kFastStep_s), kDischargeStep_s - 4 * kFastStep_s);
    if (k > 1000) {
      least_A = std::min(least_A, charge / (4 * kFastStep_s));
      most_A = std::max(most_A, charge / (4 * kFastStep_s));
    }
    if (k % 500 == 100) curve.x.push_back(k * kDischargeStep_s), curve.y.push_back(bus_V);
  }
  const double start_V = curve.y.front();
  return {
      {.title = "Ten minutes of hover on 4S 2200 mAh",
       .x_label = "time / s",
       .y_label = "bus voltage / V",
       .source = "Bangura2017, fig. 2.11 (band of four packs)",
       .model = {curve},
       .reference = {{"upper", {0.0, 600.0}, {16.8, 15.0}}, {"lower", {0.0, 600.0}, {16.4, 14.5}}},
       .figures = {{"voltage at the start less 16.6", start_V - 16.6, 0.2, "V"},
                   {"voltage at the end less 14.75", bus_V - 14.75, 0.25, "V"},
                   {"least bus current per motor less 1.35", least_A - 1.35, 0.10, "A"},
                   {"most bus current per motor less 1.35", most_A - 1.35, 0.10, "A"},
                   {"charge taken", pack.charge_used_C() / 3.6, 2200.0, "mAh"}}}};
}

}  // namespace whirl::plant
