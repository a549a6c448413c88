// Motor and propeller against the thesis's steady points, its current-limited and open-loop steps, the
// two faces against each other, and a motor that somebody else measured.
#include <algorithm>
#include <cmath>

#include "base/angles.hpp"
#include "plant/motor/switched_motor.hpp"
#include "plant/rotor/rotor.hpp"
#include "plant/validation/kde2814.hpp"
#include "plant/validation/motor_faces.hpp"
#include "plant/validation/validation.hpp"

namespace whirl::plant {
namespace {

constexpr double kMotorStep_s = 1.25e-4;
constexpr double kSupply_V = 16.4;

double radps(double rpm) {
  return rpm * kPi / 30.0;
}
double rpm(double radps) {
  return radps * 30.0 / kPi;
}

// The rotor's static thrust and torque, tabulated once: steady() is too slow for every sub-step.
class StaticRotor {
 public:
  explicit StaticRotor(const Rotor& rotor) {
    for (double omega = kLow; omega <= kHigh; omega += kGrain) {
      RotorConditions c;
      c.omega_radps = omega;
      const RotorLoads loads = rotor.steady(c);
      torque_.push_back(loads.shaft_torque_Nm / (omega * omega));
      thrust_.push_back(loads.thrust_N / (omega * omega));
    }
  }
  double torque_Nm(double omega) const { return between(torque_, omega) * omega * omega; }
  double thrust_N(double omega) const { return between(thrust_, omega) * omega * omega; }
  ShaftLoad load(double omega) const { return {between(torque_, omega), 0.0}; }

 private:
  static constexpr double kLow = 100.0, kHigh = 701.0, kGrain = 10.0;
  static double between(const std::vector<double>& table, double omega) {
    const double place =
        std::clamp((omega - kLow) / kGrain, 0.0, static_cast<double>(table.size()) - 1.001);
    const std::size_t k = static_cast<std::size_t>(place);
    return table[k] + (place - static_cast<double>(k)) * (table[k + 1] - table[k]);
  }
  std::vector<double> torque_, thrust_;
};

double thesis_thrust_N(double omega_radps) {
  const double n = rpm(omega_radps);
  return 1.789e-7 * n * n - 1.4715e-4 * n;
}

double speed_for(double thrust_N) {  // of the thesis's static fit
  const double b = 1.4715e-4, a = 1.789e-7;
  return radps((b + std::sqrt(b * b + 4.0 * a * thrust_N)) / (2.0 * a));
}

double off_percent(double got, double want) {
  return 100.0 * (got / want - 1.0);
}

// Duty at which the motor holds this speed, and what flows then.
struct Steady {
  double voltage_V = 0.0, bus_A = 0.0, winding_A = 0.0;
};

Steady hold(const MotorParams& params, const ShaftLoad& load, double omega_radps) {
  double low = 0.0, high = 1.0;
  Steady found;
  for (int round = 0; round < 40; ++round) {
    const double duty = 0.5 * (low + high);
    AveragedMotor motor(params);
    motor.set_speed(omega_radps);
    MotorBooks books;
    for (int k = 0; k < 400; ++k) books = motor.step({kSupply_V, duty, false}, load, kMotorStep_s);
    (books.kinetic_J < 0.0 ? low : high) = duty;
    found = {duty * kSupply_V, books.bus_charge_C / kMotorStep_s,
             books.winding_charge_C / kMotorStep_s};
  }
  return found;
}

struct Point {
  double rpm, voltage_V, bus_A, thrust_N;
};
constexpr Point kThesis[] = {{4000, 4.91, 1.32, 2.27},
                             {4500, 5.69, 1.90, 2.96},
                             {5000, 6.39, 2.56, 3.74},
                             {5500, 6.93, 3.32, 4.60}};

Proof steady_points(const StaticRotor& rotor) {
  Proof proof{.title = "Motor and 10 x 4.5 at 16.4 V: the thesis's steady points",
              .x_label = "speed / RPM",
              .y_label = "V, A (bus), N",
              .source = "Bangura2017, 3.4-3.5",
              .note = "Bus current is duty x winding current: the thesis's shunt sits on the bus."};
  Curve volts{"voltage", {}, {}}, amps{"bus current", {}, {}}, thrust{"thrust", {}, {}};
  proof.reference = {volts, amps, thrust};
  double worst[3] = {};
  for (const Point& p : kThesis) {
    const double omega = radps(p.rpm);
    const Steady got = hold(MotorParams{}, rotor.load(omega), omega);
    const double model[] = {got.voltage_V, got.bus_A, rotor.thrust_N(omega)};
    const double want[] = {p.voltage_V, p.bus_A, p.thrust_N};
    Curve* curves[] = {&volts, &amps, &thrust};
    for (int i = 0; i < 3; ++i) {
      curves[i]->x.push_back(p.rpm);
      curves[i]->y.push_back(model[i]);
      proof.reference[i].x.push_back(p.rpm);
      proof.reference[i].y.push_back(want[i]);
      const double off = off_percent(model[i], want[i]);
      if (!(std::abs(off) <= std::abs(worst[i]))) worst[i] = off;
    }
  }
  proof.model = {volts, amps, thrust};
  proof.figures = {{"worst voltage", worst[0], 4.0, "%"},
                   {"worst bus current", worst[1], 6.0, "%"},
                   {"worst thrust", worst[2], 3.0, "%"}};
  return proof;
}

// The bound: all of 20 A into the shaft, nothing electrical in the way.
double bound_s(const StaticRotor& rotor, const MotorParams& p, double from, double to,
               double limit_A) {
  const int n = 2000;
  double sum = 0.0;
  for (int k = 0; k < n; ++k) {
    const double omega = from + (k + 0.5) * (to - from) / n;
    const double air = rotor.torque_Nm(omega);
    sum += p.inertia_kgm2 / (p.torque_constant_NmpA * (limit_A - p.no_load_current_A) - air) *
           (to - from) / n;
  }
  return sum;
}

// Time from speed `from` to speed `to`; step(dt) runs the motor and answers with its speed.
template <typename Step>
double rise_s(double from, double to, const Step& step) {
  double left = std::nan(""), before = 0.0;
  for (double t = 0.0; t < 0.2; t += kMotorStep_s) {
    const double now = step(kMotorStep_s);
    auto crossed = [&](double at) { return t + kMotorStep_s * (at - before) / (now - before); };
    if (std::isnan(left) && now >= from) left = crossed(from);
    if (now >= to) return crossed(to) - left;
    before = now;
  }
  return std::nan("");
}

Proof limited_step(const StaticRotor& rotor) {
  constexpr double kLimit_A = 20.0;
  const MotorParams params;
  const double start = speed_for(0.8), from = speed_for(1.12), to = speed_for(3.68);
  const double want = bound_s(rotor, params, from, to, kLimit_A);

  AveragedMotor averaged(params);
  averaged.set_speed(start);
  const double rise_averaged = rise_s(from, to, [&](double dt) {
    const double volts =
        params.torque_constant_NmpA * averaged.speed_radps() + kLimit_A * averaged.running_ohm();
    const double kick = (kLimit_A - averaged.current_A()) * params.inductance_H / dt;
    const double duty = std::clamp((volts + kick) / kSupply_V, 0.0, 1.0);
    averaged.step({kSupply_V, duty, false}, rotor.load(averaged.speed_radps()), dt);
    return averaged.speed_radps();
  });

  SwitchedMotor switched(params);
  switched.set_bus(kSupply_V);
  switched.set_speed(start);
  bool on = true;
  const double rise_switched = rise_s(from, to, [&](double dt) {
    switched.set_load(rotor.load(switched.speed_radps()));
    for (double t = 0.0; t < dt - 1e-12; t += 5e-6) {  // chops about the limit
      double most = 0.0;
      for (double i : switched.phase_currents_A()) most = std::max(most, std::abs(i));
      on = most < kLimit_A;
      switched.set_bridge(six_step(sector_of(switched.electrical_angle_rad()), on, false));
      switched.run(5e-6);
    }
    return switched.speed_radps();
  });
  return {.title = "Current-limited step, 0.8 to 4.0 N at 20 A: 10 to 90 %",
          .x_label = "case",
          .y_label = "time / s",
          .source = "closed form: integral of J dw / (Kt (20 A - no-load) - air torque)",
          .model = {{"averaged", {0.0}, {rise_averaged}}, {"switched", {1.0}, {rise_switched}}},
          .reference = {{"bound", {0.0, 1.0}, {want, want}}},
          .figures = {{"bound less the thesis's 52 ms", 1e3 * want - 52.0, 2.6, "ms"},
                      {"averaged against bound", off_percent(rise_averaged, want), 5.0, "%"},
                      {"switched against bound", off_percent(rise_switched, want), 5.0, "%"}},
          .note =
              "The switched face is slower: at each commutation two phases share the current "
              "that the limiter watches in one."};
}

Proof open_loop_step(const StaticRotor& rotor) {
  const MotorParams params;
  const double from = speed_for(2.0), to = speed_for(3.2);
  const double duty = hold(params, rotor.load(to), to).voltage_V / kSupply_V;
  const double start = hold(params, rotor.load(from), from).voltage_V / kSupply_V;
  AveragedMotor motor(params);
  motor.set_speed(from);
  for (int k = 0; k < 8000; ++k) {
    motor.step({kSupply_V, start, false}, rotor.load(motor.speed_radps()), kMotorStep_s);
  }
  Curve curve{"thrust", {}, {}};
  double t10 = std::nan(""), t90 = std::nan("");
  const double low = thesis_thrust_N(motor.speed_radps());
  const double span = thesis_thrust_N(to) - low;
  for (int k = 0; k < 4000; ++k) {
    motor.step({kSupply_V, duty, false}, rotor.load(motor.speed_radps()), kMotorStep_s);
    const double share = (thesis_thrust_N(motor.speed_radps()) - low) / span;
    const double t = (k + 1) * kMotorStep_s;
    if (std::isnan(t10) && share >= 0.1) t10 = t;
    if (std::isnan(t90) && share >= 0.9) t90 = t;
    curve.x.push_back(t);
    curve.y.push_back(low + share * span);
  }
  return {.title = "Open-loop thrust step, 2.0 to 3.2 N",
          .x_label = "time / s",
          .y_label = "thrust / N",
          .source = "Bangura2017, 3 (physical reading): about 100 ms from 10 to 90 %",
          .model = {curve},
          .reference = {{"2.0 N", {0.0, 0.5}, {2.0, 2.0}}, {"3.2 N", {0.0, 0.5}, {3.2, 3.2}}},
          .figures = {{"rise time less 100 ms", 1e3 * (t90 - t10) - 100.0, 20.0, "ms"}}};
}

Proof faces(const StaticRotor& rotor) {
  const FaceCase c{MotorParams{}, kSupply_V, rotor.load(radps(4000.0)).quadratic_Nm_s2};
  std::vector<Curve> averaged, switched;
  double worst[4] = {};
  for (bool diode : {false, true}) {
    Curve a{diode ? "averaged, diode" : "averaged, synchronous", {}, {}}, s = a;
    s.name = diode ? "switched, diode" : "switched, synchronous";
    for (double duty : {0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}) {
      const MotorFace mean = averaged_face(c, duty, diode);
      const MotorFace real = switched_face(c, duty, diode, mean.speed_radps);
      const double off[] = {off_percent(mean.speed_radps, real.speed_radps),
                            off_percent(mean.shaft_Nm, real.shaft_Nm),
                            off_percent(mean.winding_A, real.winding_A),
                            off_percent(mean.bus_A, real.bus_A)};
      for (int i = 0; i < 4; ++i) {
        if (!(std::abs(off[i]) <= std::abs(worst[i]))) worst[i] = off[i];
      }
      a.x.push_back(duty), a.y.push_back(mean.bus_A);
      s.x.push_back(duty), s.y.push_back(real.bus_A);
    }
    averaged.push_back(a), switched.push_back(s);
  }
  return {.title = "Two faces of one motor: steady bus current by duty",
          .x_label = "duty",
          .y_label = "bus current / A",
          .source = "each is the other's reference",
          .model = averaged,
          .reference = switched,
          .figures = {{"worst speed", worst[0], 1.0, "%"},
                      {"worst torque", worst[1], 1.0, "%"},
                      {"worst winding current", worst[2], 1.0, "%"},
                      {"worst bus current", worst[3], 1.0, "%"}},
          .note =
              "Both count what moving the current from phase to phase costs: 0.120 ohm and "
              "20 uH look like 0.15 to 0.16 ohm on a running motor of 7 pole pairs. That is "
              "why the thesis's 0.12 to 0.18 ohm, read from steady points, are not the DC "
              "resistance: with 0.1 mH the commutation alone would look like 0.17 ohm."};
}

// A motor that nobody here measured: from its torque and speed, foretell the bus current. The averaged
// motor holds each row's speed against its torque, at this supply; what it takes is told as power.
Proof kde() {
  MotorParams params;
  params.torque_constant_NmpA = 60.0 / (2.0 * kPi * 775.0);
  params.resistance_ohm = 0.06 + 0.03;
  params.winding_resistance_ohm = 0.06;
  params.inductance_H = 0.2e-3 * params.resistance_ohm;
  params.no_load_current_A = 0.6;
  Curve model{"model", {}, {}}, data{"stand", {}, {}};
  double watts2 = 0.0, watts_amps = 0.0;
  auto power_W = [&](const StandRow& row) {
    const double omega = radps(row.speed_rpm);
    return kSupply_V * hold(params, {row.torque_Nm / (omega * omega), 0.0}, omega).bus_A;
  };
  for (const StandRow& row : kKde2814) {  // the pack's voltage was not recorded: one for all rows
    if (row.speed_rpm < 2000.0) continue;
    watts2 += power_W(row) * power_W(row);
    watts_amps += power_W(row) * row.bus_A;
  }
  const double bus_V = watts2 / watts_amps;
  double square = 0.0, most = 0.0;
  int n = 0;
  for (const StandRow& row : kKde2814) {
    if (row.speed_rpm < 2000.0) continue;
    model.x.push_back(row.speed_rpm), model.y.push_back(power_W(row) / bus_V);
    data.x.push_back(row.speed_rpm), data.y.push_back(row.bus_A);
    const double off = power_W(row) / bus_V - row.bus_A;
    square += off * off;
    most = std::max(most, row.bus_A);
    ++n;
  }
  return {.title = "KDE2814XF-775 on a stand: bus current from torque and speed",
          .x_label = "speed / RPM",
          .y_label = "bus current / A",
          .source =
              "MIT1580; Kv from its name; 0.06 ohm, 0.03 ohm of bridge and leads, 0.2 ms and 0.6 A "
              "assumed",
          .model = {model},
          .reference = {data},
          .figures = {{"RMS error over the largest current", 100.0 * std::sqrt(square / n) / most,
                       2.0, "%"},
                      {"pack voltage that fits", bus_V, 12.6, "V"}},
          .note = "Compared and reported: one unrecorded voltage is fitted for a sagging 3S pack."};
}

}  // namespace

std::vector<Proof> motor_proofs(const std::shared_ptr<const Blade>& blade) {
  const StaticRotor rotor{Rotor(blade, 1)};
  return {steady_points(rotor), limited_step(rotor), open_loop_step(rotor), faces(rotor), kde()};
}

}  // namespace whirl::plant
