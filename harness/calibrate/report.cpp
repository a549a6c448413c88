#include "harness/calibrate/report.hpp"

#include <cmath>
#include <cstdio>

#include "base/rpm.hpp"
#include "base/text.hpp"
#include "firmware/esc/core/calibration.hpp"
#include "firmware/esc/core/thrust_model.hpp"

namespace whirl::calibrate {
namespace {

template <typename... T>
std::string format(const char* form, T... values) {
  char text[256];
  std::snprintf(text, sizeof text, form, values...);
  return text;
}

// What they are apparent by: bus current over duty is so much less than the winding's (docs/commutation.md),
// and so must its limit be, in the same amperes.
constexpr double kWinding_over_apparent = 1.1;

double shared(const Calibration& c) {
  return c.still.updraft_share * (1.0 - c.air_within);
}

struct Setting {
  std::string name;
  double value;
};

std::vector<Setting> settings(const Calibration& c) {
  std::vector<Setting> all = {
      {"gain", c.sense.gain.value},
      {"offset", c.sense.offset.value},
      {"loss_ohm", c.motor.loss_ohm.value},
      {"loss_volt", c.motor.loss_V.value},
      {"loss_share", c.motor.loss_share.value},
      {"loss_emf", c.motor.loss_emf.value},
      {"loss_bus", c.motor.bus_V},
      {"drag", c.motor.drag.value},
      {"inertia", c.motor.inertia.value},
      {"c0", c.rotor.c0.value},
      {"c1", c.rotor.c1.value},
      {"c2", c.rotor.c2.value},
      {"c3", c.rotor.c3.value},
      {"c4", c.rotor.c4},
      {"d0", c.rotor.d0.value},
      {"d1", c.rotor.d1.value},
      {"power_from", c.rotor.range_radps.low},
      {"power_to", c.rotor.range_radps.high},
      {"speed_effect", c.rotor.speed_effect.value},
  };
  if (c.tell_motor) {
    all.push_back({"kt", c.motor.back_emf.value});
    all.push_back({"no_load", c.motor.no_load_current.value});
    all.push_back({"resistance", c.motor.resistance.value});
    all.push_back({"overlap", c.motor.overlap.value});
    all.push_back(
        {"max_current", fw::esc::MotorConstants{}.max_current_A / kWinding_over_apparent});
  }
  for (const auto& map : {c.still.a, c.still.q}) {
    for (const Coefficient& x : map) all.push_back({x.name, x.value});
  }
  if (c.still.updraft_share > 0.0) all.push_back({"shared", shared(c)});
  return all;
}

std::string row(const Coefficient& c) {
  return format("  %-14s %13.5g  +- %-10.2g %s\n", c.name.c_str(), c.value, c.half_width,
                c.unit.c_str());
}

std::string block(const Fit& fit, const std::vector<Coefficient>& rows) {
  std::string text =
      format("%s: R2 %.5f, residual %.3g %s, condition %.0f, %d points\n", fit.name.c_str(), fit.r2,
             fit.residual_rms, fit.unit.c_str(), fit.condition, static_cast<int>(fit.y.size()));
  for (const Coefficient& c : rows) text += row(c);
  return text;
}

fw::esc::ThrustModel model_of(const RotorFit& rotor) {
  const auto f = [](double x) { return static_cast<float>(x); };
  return {f(rotor.c0.value), f(rotor.c1.value), f(rotor.c2.value), f(rotor.c3.value),
          f(rotor.c4),       f(rotor.d0.value), f(rotor.d1.value)};
}

}  // namespace

Result<Calibration> identify(StandData data) {
  auto sense = fit_sense(data);
  if (!sense) return sense.error();
  auto motor = fit_motor(data, sense.value());
  if (!motor) return motor.error();
  auto still = fit_still_air(data, motor.value());
  if (!still) return still.error();
  auto rotor = fit_rotor(data, motor.value(), still.value());
  if (!rotor) return rotor.error();
  return Calibration{std::move(data), sense.value(), motor.value(), still.value(), rotor.value()};
}

Result<Calibration> identify(StandData data, const Setup& setup) {
  auto found = identify(std::move(data));
  if (found) {
    found.value().tell_motor = setup.tell_motor;
    found.value().air_within = setup.air_within;
  }
  return found;
}

Result<Done> physical(const Calibration& c) {
  for (const Coefficient* x :
       {&c.sense.gain, &c.motor.torque_constant, &c.motor.back_emf, &c.motor.resistance,
        &c.motor.inertia, &c.still.a[0], &c.still.q[0]}) {
    if (auto good = physical(*x, 0.0); !good) return good;
  }
  return physical(c.rotor, c.data.radius_m);
}

std::vector<std::string> lines(const Calibration& c) {
  std::vector<std::string> out;
  for (const Setting& s : settings(c))
    out.push_back(format("set %s %.7g", s.name.c_str(), s.value));
  return out;
}

std::string lua_file(const Calibration& c, const std::string& made_by) {
  std::string text = "-- Made by: " + printable_line(made_by) +
                     "\n-- What the ESC is told over its serial line, SI.\ncalibration = {\n";
  for (const std::string& line : lines(c)) text += "  \"" + line + "\",\n";
  return text + "}\nreturn { kind = \"esc_calibration\", set = calibration }\n";
}

std::string table(const Calibration& c) {
  std::string text =
      block(c.sense.fit, {c.sense.gain, c.sense.offset}) +
      block(c.motor.torque, {c.motor.torque_constant, c.motor.no_load_current}) +
      block(c.motor.voltage, {c.motor.back_emf, c.motor.resistance, c.motor.overlap});
  text += block(c.motor.impulse, {c.motor.inertia}) +
          block(c.motor.losses, c.motor.losses.coefficients);
  text += block(c.still.thrust, c.still.a) + block(c.still.torque, c.still.q) +
          block(c.rotor.zero, {c.rotor.c3}) +
          block(c.rotor.power, {c.rotor.c0, c.rotor.d0, c.rotor.d1, c.rotor.speed_effect}) +
          block(c.rotor.line, {c.rotor.c1, c.rotor.c2}) +
          format("  %-14s %13.5g  computed\n", "c4", c.rotor.c4);
  if (c.still.updraft_share > 0.0) {
    text += format(
        "  %-14s %13.5g  of still air's power: %.5g in an updraft, %.3g %% less in other air\n",
        "shared", shared(c), c.still.updraft_share, 100.0 * c.air_within);
  }
  text += "thrust found back from power:\n    wind    rpm   thrust   kappa   error\n";
  const std::vector<double> errors = found_back(c.rotor);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const RotorPoint& p = c.rotor.points[i];
    text += format("  %6.2f %6.0f %8.3f %7.3f  ", p.wind_mps, rpm_of(p.speed_radps), p.thrust_N,
                   p.kappa);
    text +=
        std::isnan(errors[i]) ? "power does not tell\n" : format("%6.2f %%\n", 100.0 * errors[i]);
  }
  return text;
}

std::vector<double> found_back(const RotorFit& rotor) {
  const fw::esc::ThrustModel model = model_of(rotor);
  const fw::esc::RotorPoint still = fw::esc::at_inflow(model, 0.0f);
  std::vector<double> errors;
  for (const RotorPoint& p : rotor.points) {
    fw::esc::ThrustSolver solver(model);
    const double ratio = p.CP / rotor.still_CP;  // as ThrustEstimator does it
    const fw::esc::ThrustEstimate e = solver.solve(static_cast<float>(ratio) * still.CP);
    const double CT = static_cast<double>(e.CT / still.CT) * rotor.still_CT;
    errors.push_back(e.status == fw::esc::Estimate::converged ? CT / p.CT - 1.0 : std::nan(""));
  }
  return errors;
}

}  // namespace whirl::calibrate
