// One blade section: lift and drag over angle of attack and Reynolds number.
//
//   In       curves as measured or computed, one per Reynolds number, about stall to stall
//   Out      section_coefficients(alpha, Re) for any alpha on the full circle, any Re > 0
//   Valid    inside the given curves: linear between rows, linear in log Re between curves. Beyond
//            stall the curve runs into a flat plate of the blade's aspect ratio (Viterna). Below
//            the lowest Re drag is held and lift falls as Re^0.1 or as the file says (computed from 60k
//            to 30k: E63, 4 % thick, Re^0.1; NACA 4412, 12 %, Re^0.45); above the highest friction falls as Re^-1/5.
//   Source   plate: [Hoerner]; drag at 90 deg 1.11 + 0.018 AR [Viterna]
//   Left out pitching moment (torsion.hpp takes it from the angle of zero lift), hysteresis at stall, compressibility.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

namespace whirl::plant {

struct PolarRow {
  double alpha_rad = 0.0;
  double cl = 0.0;
  double cd = 0.0;
};

struct PolarCurve {
  double reynolds = 0.0;
  std::vector<PolarRow> rows;  // ascending in alpha
};

struct SectionCoefficients {
  double cl = 0.0;
  double cd = 0.0;
};

class PolarFamily {
 public:
  // Curves ascending in Reynolds number, each ascending in alpha; checked by read_polar().
  // Below the first curve lift falls as Re^lift_below; drag is known within its share drag_within.
  PolarFamily(std::string name, std::vector<PolarCurve> curves, double lift_below = 0.1,
              double drag_within = 0.0);

  SectionCoefficients at(double alpha_rad, double reynolds) const;

  // Angle and slope of zero lift on the attached part, from a line fit over -2..4 deg.
  struct Attached {
    double alpha0_rad = 0.0;
    double slope_per_rad = 0.0;
  };
  Attached attached(double reynolds) const;

  const std::string& name() const { return name_; }
  const std::vector<PolarCurve>& curves() const { return curves_; }
  double drag_within() const { return drag_within_; }  // 0: nothing is stated
  // The same with all given drag times this.
  PolarFamily with_drag(double factor) const;

 private:
  std::string name_;
  std::vector<PolarCurve> curves_;
  double lift_below_;
  double drag_within_;
};

// Text of a .polar file: "section NAME", then blocks "reynolds RE" of rows "alpha_deg cl cd".
// Before them "below N" may give lift_below, "drag_within N" the share by which a computed section's drag may be off. '#' starts a comment. `place` is the file's name for errors.
Result<PolarFamily> read_polar(std::string_view text, std::string_view place);

}  // namespace whirl::plant
