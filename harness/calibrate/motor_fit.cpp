// The regressions, one after another, with their reasons: docs/motor_fit.md.
#include <algorithm>

#include "firmware/esc/core/power_balance.hpp"
#include "harness/calibrate/identify.hpp"

namespace whirl::calibrate {
namespace {

using regression::Problem;

constexpr double kShortest_duty = 0.02;
constexpr std::size_t kWindow = 25;  // samples over which the momentum's change is taken

struct Moment {  // of a motor: what the three regressions need
  double voltage_V, current_A, speed_radps;
};

Moment moment(const Sample& s) {
  return {s.duty * s.bus_V, s.bus_A / s.duty, s.speed_radps};
}

Problem line_problem(const std::vector<SteadyPoint>& points) {
  Problem p{"torque constant",
            "winding current",
            "A",
            {},
            {{"no_load", "A", {}}, {"per torque", "A/(N m)", {}}}};
  for (const SteadyPoint& x : points) {
    p.y.push_back(x.meter_A / x.duty);
    p.columns[0].x.push_back(1.0);
    p.columns[1].x.push_back(x.torque_Nm);
  }
  return p;
}

// What of the electrical power does not reach the air; errors count as shares of shaft power.
Problem loss_problem(const std::vector<SteadyPoint>& points) {
  Problem p{"losses",
            "electrical less shaft power",
            "W",
            {},
            {{"loss_ohm", "ohm", {}}, {"loss_volt", "V", {}}, {"drag", "N m", {}}}};
  for (const SteadyPoint& x : points) {
    const double amps = x.meter_A / x.duty, shaft_W = x.torque_Nm * x.speed_radps;
    p.y.push_back(x.esc_V * x.meter_A - shaft_W);
    p.columns[0].x.push_back(amps * amps);
    p.columns[1].x.push_back(amps);
    p.columns[2].x.push_back(x.speed_radps);
    p.weights.push_back(1.0 / shaft_W);
  }
  return p;
}

// The same, and the shares of power by voltage and power by back-EMF: nearly collinear columns.
Problem witness_problem(const std::vector<SteadyPoint>& points) {
  Problem p = loss_problem(points);
  p.columns.push_back({"loss_share", "", {}});
  p.columns.push_back({"loss_emf", "V s/rad", {}});
  for (const SteadyPoint& x : points) {
    p.columns[3].x.push_back(x.esc_V * x.meter_A);
    p.columns[4].x.push_back(x.speed_radps * x.meter_A / x.duty);
  }
  p.worst_condition = 5000.0;
  return p;
}

// By both witnesses if the points tell them apart, and both have a share.
Result<Fit> fit_losses(const std::vector<SteadyPoint>& points) {
  const auto both = solve(witness_problem(points));
  if (both && both.value().value("loss_share") > 0.0 && both.value().value("loss_share") < 1.0 &&
      both.value().value("loss_emf") < 0.0) {
    return both;
  }
  auto one = solve(loss_problem(points));
  if (!one) return one.error();
  for (const char* absent : {"loss_share", "loss_emf"}) {
    one.value().coefficients.push_back({absent, "", 0.0, 0.0, 0.0});
  }
  return one;
}

Problem voltage_problem(const std::vector<Sample>& samples) {
  Problem p{"motor voltage",
            "motor voltage",
            "V",
            {},
            {{"ke", "V s/rad", {}}, {"resistance", "ohm", {}}, {"overlap", "ohm s/rad", {}}},
            {},
            true};
  for (const Sample& s : samples) {
    const Moment m = moment(s);
    p.y.push_back(m.voltage_V);
    p.columns[0].x.push_back(m.speed_radps);
    p.columns[1].x.push_back(m.current_A);
    p.columns[2].x.push_back(m.speed_radps * m.current_A);
  }
  return p;
}

double motor_torque_Nm(const MotorFit& motor, const Moment& m) {
  return motor.power_W(m.voltage_V, m.current_A, m.speed_radps) / m.speed_radps;
}

// The motor's torque over a window of time: what the rotor gained and what the air took.
void add_windows(Problem& p, const MotorFit& motor, const std::vector<Sample>& samples) {
  for (std::size_t i = 0; i + kWindow < samples.size(); i += kWindow) {
    double impulse = 0.0, square = 0.0;
    for (std::size_t k = i; k < i + kWindow; ++k) {
      const Moment a = moment(samples[k]), b = moment(samples[k + 1]);
      const double half_s = 0.5 * (samples[k + 1].t_s - samples[k].t_s);
      impulse += half_s * (motor_torque_Nm(motor, a) + motor_torque_Nm(motor, b));
      square += half_s * (a.speed_radps * a.speed_radps + b.speed_radps * b.speed_radps);
    }
    p.y.push_back(impulse);
    p.columns[0].x.push_back(samples[i + kWindow].speed_radps - samples[i].speed_radps);
    p.columns[1].x.push_back(square);
  }
}

Problem impulse_problem(const StandData& data, const SenseFit& sense, const MotorFit& motor) {
  Problem p{"inertia",
            "motor's impulse",
            "N m s",
            {},
            {{"inertia", "kg m2", {}}, {"air", "N m s2/rad2", {}}},
            {},
            true};
  for (std::vector<Sample> samples : {data.steps, data.sinusoid}) {
    for (Sample& s : samples) s.bus_A = sense.true_A(s.bus_A);
    add_windows(p, motor, samples);
  }
  return p;
}

Result<Done> check_duty(const StandData& data) {
  const auto wrong = [](const auto& x) { return !(x.duty >= kShortest_duty); };
  const auto points = working_points(data);
  if (std::none_of(points.begin(), points.end(), wrong) &&
      std::none_of(data.steps.begin(), data.steps.end(), wrong) &&
      std::none_of(data.sinusoid.begin(), data.sinusoid.end(), wrong)) {
    return Done{};
  }
  return Error{ErrorKind::bad_input, "fit of the motor", "the bridge was off at a point",
               "did the ESC stop the motor?"};
}

}  // namespace

double MotorFit::power_W(double voltage_V, double current_A, double speed_radps) const {
  const auto f = [](double x) { return static_cast<float>(x); };
  const fw::esc::LossMap map{.loss_ohm = f(loss_ohm.value),
                             .loss_V = f(loss_V.value),
                             .share = f(loss_share.value),
                             .back_emf_Vs = f(loss_emf.value),
                             .drag_Nm = f(drag.value)};
  return fw::esc::aerodynamic_power_W(map, f(voltage_V), f(current_A), f(speed_radps));
}

double MotorFit::power_W(const SteadyPoint& x) const {
  return power_W(x.esc_V * x.duty, x.meter_A / x.duty, x.speed_radps);
}

Result<MotorFit> fit_motor(const StandData& data, const SenseFit& sense) {
  if (auto good = check_duty(data); !good) return good.error();
  const std::vector<SteadyPoint> points = working_points(data);
  auto line = solve(line_problem(points));
  if (!line) return line.error();
  auto losses = fit_losses(points);
  if (!losses) return losses.error();
  std::vector<Sample> samples = data.sinusoid;
  for (Sample& s : samples) s.bus_A = sense.true_A(s.bus_A);
  for (const SteadyPoint& x : data.still) {
    samples.push_back({0.0, x.duty, x.speed_radps, x.meter_A, x.esc_V});
  }
  auto voltage = solve(voltage_problem(samples));
  if (!voltage) return voltage.error();

  MotorFit motor;
  motor.losses = losses.value();
  motor.torque = line.value();
  motor.voltage = voltage.value();
  motor.loss_ohm = motor.losses["loss_ohm"];
  motor.loss_V = motor.losses["loss_volt"];
  motor.drag = motor.losses["drag"];
  motor.loss_share = motor.losses["loss_share"];
  motor.loss_emf = motor.losses["loss_emf"];
  for (const SteadyPoint& x : points) motor.bus_V += x.esc_V / static_cast<double>(points.size());
  motor.torque_constant = inverse(motor.torque, "per torque", "kt", "N m/A");
  motor.no_load_current = motor.torque["no_load"];
  motor.back_emf = motor.voltage["ke"];
  motor.resistance = motor.voltage["resistance"];
  motor.overlap = motor.voltage["overlap"];
  auto impulse = solve(impulse_problem(data, sense, motor));
  if (!impulse) return impulse.error();
  motor.impulse = impulse.value();
  motor.inertia = motor.impulse["inertia"];
  return motor;
}

}  // namespace whirl::calibrate
