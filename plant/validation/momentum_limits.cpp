#include "plant/validation/momentum_limits.hpp"

#include <cmath>

#include "base/angles.hpp"
#include "plant/validation/axial_blade.hpp"

namespace whirl::plant {
namespace {

// Induced velocity over its hover value for a given thrust, at climb V/vh and in-plane Vxy/vh.
double induced_ratio(double climb, double in_plane) {
  RingWake wake{.r_m = 1.0,
                .dr_m = 1.0,
                .climb_mps = climb,
                .in_plane_mps = in_plane,
                .blade_speed_mps = 10.0,
                .swirl = false};
  const double hover_thrust = 4.0 * kPi * wake.density_kgpm3;  // u = 1 m/s through this ring
  const auto constant = [&](double, double) { return RingForce{hover_thrust, 0.0, 0.1}; };
  return balance_ring(wake, constant, {}).u_mps;
}

double climb_root(double x) {
  return -0.5 * x + std::sqrt(0.25 * x * x + 1.0);
}
double windmill_root(double x) {
  return -0.5 * x - std::sqrt(0.25 * x * x - 1.0);
}
double measured_descent(double x) {
  return 1.0 + x * (-1.125 + x * (-1.372 + x * (-1.718 - 0.655 * x)));
}

// Worst of a span of x between our curve and a closed form, in percent.
template <typename Closed>
double worst_percent(double from, double to, Closed closed) {
  double worst = 0.0;
  for (double x = from; x <= to + 1e-9; x += 0.05) {
    worst = std::fmax(worst, 100.0 * std::abs(induced_ratio(x, 0.0) / closed(x) - 1.0));
  }
  return worst;
}

struct Optimum {
  double thrust_off = 0.0;
  double power_off = 0.0;
  double uniformity = 0.0;
};

// The optimum hovering blade at a small angle of attack, no loss, no swirl: every ring must find the
// same induced velocity, and the sums the closed forms.
Optimum optimum_blade() {
  constexpr double R = 0.127, ctip = 0.006, omega = 500.0, alpha = 0.05, rho = 1.225;
  constexpr double cl0 = 0.2, slope = 5.7, cd0 = 0.01, K = 0.02;
  constexpr int B = 2;
  const double cl = cl0 + slope * alpha;
  const double cd = cd0 + K * cl * cl;
  const double thrust_want = 0.25 * B * rho * omega * omega * R * R * R * ctip * cl;  // eq. 4.66
  const double u = std::sqrt(thrust_want / (2.0 * rho * kPi * R * R));
  const double power_want = B * rho * ctip * std::pow(R, 4) * std::pow(omega, 3) * cd / 6.0 +
                            thrust_want * u;  // eq. 4.68
  const auto section = [&](double a, double, double) {
    struct {
      double cl, cd;
    } k{cl0 + slope * a, 0.0};
    k.cd = cd0 + K * k.cl * k.cl;
    return k;
  };
  constexpr int kRings = 40;
  constexpr double root = 0.3 * R;
  const double dr = (R - root) / kRings;
  Optimum out;
  double thrust = 0.0, power = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const double r = root + (i + 0.5) * dr;
    const RingWake wake{.density_kgpm3 = rho, .blade_speed_mps = omega * r, .swirl = false};
    const AxialSolution s =
        solve_axial({r, ctip * R / r, alpha + std::atan(u / (omega * r))}, wake, section);
    thrust += B * s.normal_Npm * dr;
    power += B * s.tangential_Npm * r * omega * dr;
    out.uniformity = std::fmax(out.uniformity, 100.0 * std::abs(s.u_mps / u - 1.0));
  }
  // The closed forms over the span that was summed: thrust grows as r^2, profile power as r^3.
  const double x = root / R;
  const double thrust_part = thrust_want * (1.0 - x * x);
  const double power_part =
      (power_want - thrust_want * u) * (1.0 - x * x * x) + thrust_want * u * (1.0 - x * x);
  out.thrust_off = 100.0 * std::abs(thrust / thrust_part - 1.0);
  out.power_off = 100.0 * std::abs(power / power_part - 1.0);
  return out;
}

Plot descent_plot() {
  Series mine{"ring balance", {}, {}, false}, momentum{"momentum theory", {}, {}, true};
  Series measured{"measured in descent", {}, {}, true};
  for (double x = -4.0; x <= 4.001; x += 0.1) {
    mine.x.push_back(x), mine.y.push_back(induced_ratio(x, 0.0));
    if (x >= 0.0) momentum.x.push_back(x), momentum.y.push_back(climb_root(x));
    if (x <= -2.0) momentum.x.push_back(x), momentum.y.push_back(windmill_root(x));
    if (x > -2.0 && x < 0.0) measured.x.push_back(x), measured.y.push_back(measured_descent(x));
  }
  return {"Induced velocity in vertical flight",
          "V / vh (climb positive)",
          "u / vh",
          {mine, momentum, measured}};
}

}  // namespace

Report validate_momentum_limits() {
  Report report{"Momentum limits and the optimum blade",
                "[Leishman, ch. 2], [Bangura2017, eq. 4.66-4.68]",
                {descent_plot()},
                {},
                {}};
  const double fast = 20.0;
  const double glauert = std::sqrt(std::sqrt(0.25 * std::pow(fast, 4) + 1.0) - 0.5 * fast * fast);
  const Optimum o = optimum_blade();
  report.figures = {{"hover and climb to 10 vh", "%", worst_percent(0.0, 10.0, climb_root), 1e-6},
                    {"windmill brake state from 2 to 10 vh", "%",
                     worst_percent(-10.0, -2.0, windmill_root), 1e-4},
                    {"vortex ring against the measured quartic", "%",
                     worst_percent(-1.95, -0.05, measured_descent), 4.0},
                    {"forward flight at 20 vh, Glauert", "%",
                     100.0 * std::abs(induced_ratio(0.0, fast) / glauert - 1.0), 1e-6},
                    {"optimum blade: thrust, eq. 4.66", "%", o.thrust_off, 1.5},
                    {"optimum blade: power, eq. 4.68", "%", o.power_off, 1.5},
                    {"optimum blade: inflow uniform within", "%", o.uniformity, 1.5}};
  report.notes = {
      "Equations 4.66-4.68 hold for small inflow angles: 1.5 % is their own error at the "
      "inner rings (inflow angle 0.11 rad)."};
  return report;
}

}  // namespace whirl::plant
