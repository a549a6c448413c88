#include <cmath>

#include "base/angles.hpp"
#include "plant/validation/akima.hpp"
#include "plant/validation/axial_blade.hpp"
#include "plant/validation/blade_element_references.hpp"

namespace whirl::plant {
namespace {

constexpr double kInch = 0.0254;
constexpr const char* kSource = "CCBlade.jl test suite [CCBlade]";

struct Lift_drag {
  double cl;
  double cd;
};

class SplinedSection {
 public:
  SplinedSection(const std::string& text, double more_drag)
      : cl_(column(text, 0), column(text, 1)),
        cd_(column(text, 0), column(text, 2)),
        more_drag_(more_drag) {}
  Lift_drag operator()(double alpha, double, double) const {
    return {cl_(alpha), cd_(alpha) + more_drag_};
  }

 private:
  static std::vector<double> column(const std::string& text, std::size_t i) {
    std::vector<double> out;
    for (const auto& row : read_rows(text, 3)) out.push_back(i == 0 ? row[0] * kDeg : row[i]);
    return out;
  }
  Akima cl_, cd_;
  double more_drag_;
};

struct ThrustTorque {
  double thrust_N = 0.0;
  double torque_Nm = 0.0;
};

ThrustTorque case_a(double speed_mps) {
  constexpr double R = 0.8;
  constexpr double dr = 0.9 * R / 10.0;
  const double omega = 2100.0 * kPi / 30.0;
  const auto section = [](double alpha, double, double) {
    const double cl = 6.2 * alpha;
    return Lift_drag{cl, 0.008 - 0.003 * cl + 0.01 * cl * cl};
  };
  ThrustTorque sum;
  for (int i = 0; i <= 10; ++i) {
    const double r = R / 10.0 + i * dr;
    const RingWake wake{.climb_mps = speed_mps, .blade_speed_mps = omega * r};
    const AxialSolution s = solve_axial({r, 0.1, std::atan(1.0 / (2.0 * kPi * r))}, wake, section);
    sum.thrust_N += 2.0 * s.normal_Npm * dr;
    sum.torque_Nm += 2.0 * s.tangential_Npm * r * dr;
  }
  return sum;
}

// Trapezoids over the stations, zero load at hub and tip.
ThrustTorque integrate(const std::vector<double>& r, const std::vector<AxialSolution>& s,
                       double hub_m, double tip_m, int blades) {
  ThrustTorque sum;
  double last_r = hub_m, last_n = 0.0, last_t = 0.0;
  for (std::size_t i = 0; i <= r.size(); ++i) {
    const bool end = i == r.size();
    const double here = end ? tip_m : r[i];
    const double n = end ? 0.0 : s[i].normal_Npm;
    const double t = end ? 0.0 : s[i].tangential_Npm * here;
    sum.thrust_N += 0.5 * blades * (here - last_r) * (n + last_n);
    sum.torque_Nm += 0.5 * blades * (here - last_r) * (t + last_t);
    last_r = here, last_n = n, last_t = t;
  }
  return sum;
}

struct CaseB {
  std::vector<AxialStation> stations;
  SplinedSection section;

  std::vector<AxialSolution> at(double speed_mps, double omega) const {
    std::vector<AxialSolution> out;
    for (const AxialStation& s : stations) {
      const RingWake wake{.climb_mps = speed_mps,
                          .blade_speed_mps = omega * s.r_m,
                          .tip_m = 3.0 * kInch,
                          .root_m = 0.5 * kInch};
      out.push_back(solve_axial(s, wake, section));
    }
    return out;
  }
};

}  // namespace

Report validate_ccblade_a(const std::string& text) {
  Report report{"CCBlade case a: analytic polar, no losses", kSource, {}, {}, {}};
  Series thrust{"this plant", {}, {}, false}, printed{"CCBlade", {}, {}, true};
  Series torque = thrust, printed_torque = printed;
  double worst_N = 0.0, worst_Nm = 0.0;
  for (const auto& row : read_rows(text, 3)) {
    const ThrustTorque got = case_a(row[0]);
    worst_N = std::fmax(worst_N, std::abs(got.thrust_N - row[1]));
    worst_Nm = std::fmax(worst_Nm, std::abs(got.torque_Nm - row[2]));
    for (Series* s : {&thrust, &printed, &torque, &printed_torque}) s->x.push_back(row[0]);
    thrust.y.push_back(got.thrust_N), printed.y.push_back(row[1]);
    torque.y.push_back(got.torque_Nm), printed_torque.y.push_back(row[2]);
  }
  report.plots = {{"Thrust", "flight speed, m/s", "thrust, N", {thrust, printed}},
                  {"Torque", "flight speed, m/s", "torque, N m", {torque, printed_torque}}};
  report.figures = {{"largest difference of thrust", "N", worst_N, 0.01},
                    {"largest difference of torque", "N m", worst_Nm, 0.002}};
  return report;
}

Report validate_ccblade_b(const std::string& sections, const std::string& sweep,
                          const std::string& polar) {
  Report report{"CCBlade case b: tip and hub loss", kSource, {}, {}, {}};
  CaseB b{{}, SplinedSection(polar, 0.0)};
  const Rows rows = read_rows(sections, 7);
  for (const auto& row : rows) {
    b.stations.push_back({row[0] * kInch, row[1] * kInch, row[2] * kDeg});
  }
  const double omega = 8000.0 * kPi / 30.0;
  const auto got = b.at(10.0, omega);
  double worst[4] = {};
  Series load{"this plant", {}, {}, false}, printed{"CCBlade", {}, {}, true};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    // Printed is what leaves the same load in a ring without loss, not the velocity at the blade.
    const double u = got[i].u_mps;
    const double mean = 0.5 * (std::sqrt(100.0 + 4.0 * u * (10.0 + u) * got[i].loss) - 10.0);
    const double mine[4] = {got[i].normal_Npm, got[i].tangential_Npm, mean / 10.0,
                            got[i].v_mps * mean / u / 10.0};
    for (std::size_t k = 0; k < 4; ++k) {
      worst[k] = std::fmax(worst[k], 100.0 * std::abs(mine[k] / rows[i][3 + k] - 1.0));
    }
    load.x.push_back(rows[i][0]), load.y.push_back(mine[0]);
    printed.x.push_back(rows[i][0]), printed.y.push_back(rows[i][3]);
  }
  std::vector<double> r;
  for (const auto& s : b.stations) r.push_back(s.r_m);
  const double D = 6.0 * kInch, n = 8000.0 / 60.0;
  double worst_CT = 0.0, worst_CP = 0.0;
  Series ct{"this plant", {}, {}, false}, ct_printed{"CCBlade", {}, {}, true};
  for (const auto& row : read_rows(sweep, 4)) {
    const auto sum = integrate(r, b.at(row[0] * n * D, omega), 0.5 * kInch, 3.0 * kInch, 2);
    const double CT = sum.thrust_N / (1.225 * n * n * std::pow(D, 4));
    const double CP = 2.0 * kPi * sum.torque_Nm / (1.225 * n * n * std::pow(D, 5));
    worst_CT = std::fmax(worst_CT, std::abs(CT - row[1]));
    worst_CP = std::fmax(worst_CP, std::abs(CP - row[2]));
    ct.x.push_back(row[0]), ct.y.push_back(CT);
    ct_printed.x.push_back(row[0]), ct_printed.y.push_back(row[1]);
  }
  report.plots = {{"Load along the blade at 10 m/s", "radius, in", "N/m", {load, printed}},
                  {"Thrust coefficient", "advance ratio J", "CT", {ct, ct_printed}}};
  report.figures = {
      {"normal load", "%", worst[0], 0.1},           {"tangential load", "%", worst[1], 0.1},
      {"axial induction", "%", worst[2], 0.1},       {"swirl induction", "%", worst[3], 0.1},
      {"CT over advance ratio", "", worst_CT, 1e-3}, {"CP over advance ratio", "", worst_CP, 1e-3}};
  return report;
}

Report validate_ccblade_c(const std::string& text, const std::string& polar) {
  Report report{"CCBlade case c: hover over collective pitch", kSource, {}, {}, {}};
  report.notes = {"A regression table of that program, not a measurement; it leaves swirl out."};
  constexpr double hub = 0.014478, tip = 0.656, omega = 83.77580409572782;
  const SplinedSection section(polar, 0.014);
  Series ct{"this plant", {}, {}, false}, ct_printed{"CCBlade", {}, {}, true};
  Series cq = ct, cq_printed = ct_printed;
  double worst_CT = 0.0, worst_CQ = 0.0;
  const double scale = 1.225 * kPi * tip * tip * std::pow(omega * tip, 2);
  for (const auto& row : read_rows(text, 3)) {
    std::vector<double> r;
    std::vector<AxialSolution> solved;
    for (int i = 0; i < 30; ++i) {
      const double at = hub + 0.01 * tip + i * (tip - hub - 0.02 * tip) / 29.0;
      const RingWake wake{.blade_speed_mps = omega * at,
                          .blade_count = 3,
                          .tip_m = tip,
                          .root_m = hub,
                          .swirl = false};
      r.push_back(at);
      solved.push_back(solve_axial({at, 0.06, row[0]}, wake, section));
    }
    const auto sum = integrate(r, solved, hub, tip, 3);
    const double CT = sum.thrust_N / scale;
    const double CQ = sum.torque_Nm / (scale * tip);
    worst_CT = std::fmax(worst_CT, std::abs(CT - row[1]));
    worst_CQ = std::fmax(worst_CQ, std::abs(CQ - row[2]));
    for (Series* s : {&ct, &ct_printed, &cq, &cq_printed}) s->x.push_back(row[0] / kDeg);
    ct.y.push_back(CT), ct_printed.y.push_back(row[1]);
    cq.y.push_back(CQ), cq_printed.y.push_back(row[2]);
  }
  const double top_CT = ct_printed.y.back(), top_CQ = cq_printed.y.back();
  report.plots = {{"Thrust", "collective, deg", "CT", {ct, ct_printed}},
                  {"Torque", "collective, deg", "CQ", {cq, cq_printed}}};
  report.figures = {{"CT, share of its largest", "%", 100.0 * worst_CT / top_CT, 1.0},
                    {"CQ, share of its largest", "%", 100.0 * worst_CQ / top_CQ, 1.0}};
  return report;
}

}  // namespace whirl::plant
