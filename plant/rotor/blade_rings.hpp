// Inside of a Blade: the disc cut into rings and, per ring, a section table made for speed.
//
//   Table    kAngles angles over the full circle, kReynolds levels even in log Re; lift and drag side
//            by side in float. Stall delay of the ring's radius is already in it.
//   Error    table against PolarFamily::at under 0.04 in lift, 13 % in drag, both
//            at the kinks where given curves meet (tests/blade_test.cpp)
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "plant/rotor/blade.hpp"
#include "plant/rotor/polar.hpp"

namespace whirl::plant {

inline constexpr int kRing_count = 20;
inline constexpr int kAzimuths = 12;
inline constexpr int kAngles = 721;  // every 0.5 deg from -180 to 180
inline constexpr int kReynolds = 20;
inline constexpr double kReynolds_low = 1e4;
inline constexpr double kReynolds_high = 6e5;

struct SectionTable {
  struct Cell {
    float cl;
    float cd;
  };
  std::vector<Cell> cells;  // [reynolds][angle]
};

struct Ring {
  double r_m = 0.0;
  double dr_m = 0.0;
  double chord_m = 0.0;
  double angle_rad = 0.0;
  double twist_share = 0.0;      // of the elastic tip twist
  double zero_lift_rad = 0.0;    // at Re 1e5
  double stall_alpha_rad = 0.0;  // at the middle Reynolds number, for the validity flag
  SectionTable table;
};

// One elastic mode per blade: tip twist = compliance x (sum of the rings' moments on that mode).
struct Torsion {
  double compliance_rad_per_Nm = 0.0;            // 0: rigid
  double flattening_kgm2 = 0.0;                  // centrifugal moment over omega squared, nose down
  double given_kgm2 = 0.0;                       // of it, what no ring's angle changes
  std::array<double, kRing_count> flat_kgm2{};   // share of a ring, before its angle
  std::array<double, kRing_count> lift_arm_m{};  // on a ring's thrust (all blades)
  std::array<double, kRing_count> camber_m3{};   // on a ring's dynamic pressure
};

class Blade {
 public:
  std::string name;
  int count = 2;
  double radius_m = 0.0;
  double root_m = 0.0;  // inner edge of the first ring
  double hub_m = 0.0;   // where the root loss starts
  double induced_factor = 1.0;
  double polar_inertia_kgm2 = 0.0;
  double flap_inertia_kgm2 = 0.0;  // one blade about the hub's centre
  double flap_stiffness_Nm_per_rad = 0.0;
  Torsion torsion;
  std::array<Ring, kRing_count> rings;
};

// The same blade with its angles turned in proportion to r/R.
std::shared_ptr<const Blade> twisted(const Blade& blade, double tip_twist_rad);

// Where a Reynolds number falls among the table's levels.
struct ReynoldsSlot {
  int level = 0;
  double weight = 0.0;  // of level + 1
};
double reynolds_of_level(int level);

// log2 of x >= 1 to 2e-5, exact at powers of two, continuous and rising: the exponent from its bits,
// the mantissa m by the series of artanh((m - 1) / (m + 1)), scaled to end at 1 for m = 2.
constexpr double artanh_series(double z) {
  const double z2 = z * z;
  return z * ((1.0 + z2 * (1.0 / 3.0)) + z2 * z2 * (0.2 + z2 * (1.0 / 7.0)));
}

inline double quick_log2(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const auto exponent = static_cast<double>(static_cast<std::int64_t>(bits >> 52) - 1023);
  const double m = std::bit_cast<double>((bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL);
  constexpr double kScale = 1.0 / artanh_series(1.0 / 3.0);
  return exponent + kScale * artanh_series((m - 1.0) / (m + 1.0));
}

inline ReynoldsSlot reynolds_slot(double reynolds) {
  constexpr double kLevels_per_octave = (kReynolds - 1.0) / 5.906890595608519;  // log2(high / low)
  static_assert(kReynolds_high / kReynolds_low == 60.0);
  const double clamped = std::clamp(reynolds, kReynolds_low, kReynolds_high);
  const double at = kLevels_per_octave * quick_log2(clamped / kReynolds_low);
  const int level = std::min(static_cast<int>(at), kReynolds - 2);
  return {level, at - level};
}

// Coefficients from the table; alpha in -pi..pi.
SectionCoefficients look_up(const SectionTable& table, ReynoldsSlot slot, double alpha_rad);

}  // namespace whirl::plant
