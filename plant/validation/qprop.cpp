#include <cmath>

#include "base/angles.hpp"
#include "plant/validation/axial_blade.hpp"
#include "plant/validation/blade_element_references.hpp"

namespace whirl::plant {
namespace {

struct LiftDrag {
  double cl;
  double cd;
};

// The section formulas of QPROP [Drela] with the constants of cam6x3.def.
LiftDrag cam6x3_section(double alpha, double speed_mps, double chord_m) {
  constexpr double cl0 = 0.50, slope = 5.8, cl_max = 1.2, cl_min = -0.3;
  constexpr double cd0 = 0.028, cd2_up = 0.050, cd2_down = 0.020, cl_cd0 = 0.5;
  const double mach = speed_mps / 340.0;
  const double reynolds = 1.225 * speed_mps * chord_m / 1.81e-5;
  double cl = (cl0 + slope * alpha) / std::sqrt(1.0 - std::fmin(mach * mach, 0.9));
  bool stalled = false;
  if (cl > cl_max || cl < cl_min) {
    stalled = true;
    cl = (cl > cl_max ? cl_max : cl_min) * std::cos(alpha + cl0 / slope);
  }
  const double over = cl - cl_cd0;
  double cd = (cd0 + (over > 0.0 ? cd2_up : cd2_down) * over * over) *
              std::pow(std::fmax(reynolds, 1e3) / 70000.0, -0.7);
  if (stalled) cd += 2.0 * std::pow(std::sin(alpha - (cl_cd0 - cl0) / slope), 2);
  return {cl, cd};
}

}  // namespace

Report validate_qprop(const std::string& text) {
  Report report{
      "QPROP: hover of the Graupner CAM 6x3", "QPROP 1.22, printed output [Drela]", {}, {}, {}};
  const double omega = 14020.0 * kPi / 30.0;
  constexpr double tip = 3.05 * 0.0254, root = 0.75 * 0.0254;
  const Rows rows = read_rows(text, 7);
  const double dr = (tip - root) / static_cast<double>(rows.size());
  double thrust = 0.0, torque = 0.0;
  Series axial{"this plant", {}, {}, false}, printed{"QPROP", {}, {}, true};
  for (const auto& row : rows) {
    const RingWake wake{.climb_mps = 0.01, .blade_speed_mps = omega * row[0], .tip_m = tip};
    const AxialSolution s =
        solve_axial({row[0], row[1], row[2] * kPi / 180.0}, wake, cam6x3_section);
    thrust += 2.0 * s.normal_Npm * dr;
    torque += 2.0 * s.tangential_Npm * row[0] * dr;
    axial.x.push_back(row[0]), axial.y.push_back(s.u_mps + 0.01);
    printed.x.push_back(row[0]), printed.y.push_back(row[6]);
  }
  report.plots = {{"Axial velocity at the disc", "radius, m", "m/s", {axial, printed}}};
  report.figures = {
      {"thrust against 3.273 N", "%", 100.0 * std::abs(thrust / 3.273 - 1.0), 2.0},
      {"torque against 0.03001 N m", "%", 100.0 * std::abs(torque / 0.03001 - 1.0), 2.0}};
  return report;
}

}  // namespace whirl::plant
