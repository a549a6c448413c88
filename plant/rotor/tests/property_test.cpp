// The whole envelope and beyond: nothing that a plan can do may bring the rotor to nonsense.
#include <limits>

#include "base/near.hpp"
#include "plant/rotor/tests/test_blades.hpp"

namespace whirl::plant {
namespace {

// splitmix64: enough for drawing states, the same everywhere.
struct Draw {
  std::uint64_t state = 20260101;
  double unit() {
    state += 0x9E3779B97F4A7C15ull;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
  }
  double between(double a, double b) { return a + (b - a) * unit(); }
};

RotorConditions any(Draw& draw, double size) {
  RotorConditions c;
  c.omega_radps = draw.between(0.0, 900.0 * size);
  for (int i = 0; i < 3; ++i) {
    c.v_AP_P_mps[i] = draw.between(-20.0, 20.0) * size;
    c.w_WP_P_radps[i] = draw.between(-10.0, 10.0) * size;
  }
  c.density_kgpm3 = draw.between(0.3, 1.4);
  if (draw.unit() < 0.2) c.height_m = draw.between(0.0, 1.0);
  return c;
}

bool finite(const RotorLoads& l) {
  return l.f_P_N.allFinite() && l.tau_P_Nm.allFinite() && std::isfinite(l.shaft_power_W) &&
         std::isfinite(l.induced_velocity_mps) && std::isfinite(l.figure_of_merit);
}

TEST(RotorProperty, HundredThousandStatesStayFiniteAndBounded) {
  Draw draw;
  Rotor rotor(hobbyking(), 1);
  for (int i = 0; i < 100000; ++i) {
    const double size = i % 10 == 0 ? 100.0 : 1.0;  // every tenth is absurd
    const RotorLoads l = rotor.step(any(draw, size), draw.between(1e-5, 5e-3));
    ASSERT_TRUE(finite(l)) << i;
    // No blade of 40 cm^2 pulls more than cl, cd of 2.5 at 300 m/s tip and 210 m/s wind allow.
    ASSERT_LT(l.f_P_N.norm(), 0.5 * 1.4 * std::pow(520.0, 2) * 2 * 0.127 * 0.035 * 2.5) << i;
  }
}

TEST(RotorProperty, NotANumberInGivesAFlagNotANumberOut) {
  Rotor rotor(hobbyking(), 1);
  RotorConditions c = hover(4000.0);
  c.v_AP_P_mps.x() = std::numeric_limits<double>::quiet_NaN();
  c.omega_radps = std::numeric_limits<double>::infinity();
  const RotorLoads l = rotor.step(c, 1e-3);
  EXPECT_TRUE(finite(l));
  EXPECT_TRUE(l.validity.out_of_range);
  EXPECT_TRUE(finite(rotor.step(hover(4000.0), 1e-3)));
}

TEST(RotorProperty, StillAirNeverBeatsTheIdealRotor) {
  Draw draw;
  const Rotor rotor(hobbyking(), 1);
  for (int i = 0; i < 100; ++i) {
    RotorConditions c = hover(draw.between(500.0, 12000.0));
    c.density_kgpm3 = draw.between(0.3, 1.4);
    const RotorLoads l = rotor.steady(c);
    ASSERT_LT(l.figure_of_merit, 0.85);
    ASSERT_GT(l.figure_of_merit, 0.2);
    ASSERT_GT(l.shaft_torque_Nm, 0.0);
    ASSERT_FALSE(l.validity.not_converged) << c.omega_radps << " " << c.density_kgpm3;
  }
}

// What the shaft gives less what the rotor does on the airframe stays with the air, and air in a
// steady flow only takes: the wind's own power is counted through the airframe's motion.
TEST(RotorProperty, TheAirOnlyTakesPower) {
  Draw draw;
  const Rotor rotor(hobbyking(), 1);
  int unconverged = 0;
  for (int i = 0; i < 400; ++i) {
    RotorConditions c;
    c.omega_radps = draw.between(50.0, 700.0);
    const double tip = 0.127 * c.omega_radps;
    c.v_AP_P_mps = {draw.between(-0.2, 0.2) * tip, draw.between(-0.2, 0.2) * tip,
                    draw.between(-0.4, 0.4) * tip};
    const RotorLoads l = rotor.steady(c);
    ASSERT_TRUE(finite(l));
    unconverged += l.validity.not_converged ? 1 : 0;
    const double to_air = l.shaft_power_W - l.f_P_N.dot(c.v_AP_P_mps);
    ASSERT_GT(to_air, 0.0) << i << " " << c.omega_radps << " " << c.v_AP_P_mps.transpose();
  }
  EXPECT_LT(unconverged, 8);  // flagged, one in fifty: stall sheets over the azimuth
}

}  // namespace
}  // namespace whirl::plant
