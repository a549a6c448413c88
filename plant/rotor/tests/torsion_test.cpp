// The soft blade: stiffness by its closed form, and what measured soft blades do.
#include "plant/rotor/torsion.hpp"

#include "base/near.hpp"
#include "plant/rotor/rotor_state.hpp"
#include "plant/rotor/tests/test_blades.hpp"
#include "plant/rotor/twist_fit.hpp"

namespace whirl::plant {
namespace {

constexpr double kDeg = 3.14159265358979323846 / 180.0;

// Constant chord and thickness, no taper.
PropellerDescription plank(double diameter_m, double thickness) {
  PropellerDescription d;
  d.place = d.name = "plank";
  d.diameter_m = diameter_m;
  d.mass_kg = 0.01;
  d.stations = {{0.15, 0.2, 12 * kDeg}, {0.6, 0.2, 12 * kDeg}, {1.0, 0.2, 12 * kDeg}};
  d.sections = {{0.2, StraightSection{}.family()}};
  d.material = kNylon;
  d.thickness_over_chord = thickness;
  return d;
}

// Under a moment q(r) = r^2 per length the slope is M/GJ, M = (R^3 - r^3)/3; the one mode's stiffness
// is the integral of GJ s'^2 for s = 1 at the tip. With x0 = 0.15 the two integrals are elementary.
TEST(Torsion, StiffnessOfAPlankMeetsItsClosedForm) {
  const double R = 0.15, c = 0.03, t = 0.06 * c;
  const double GJ = kNylon.shear_modulus_Pa * 0.152 * c * t * t * t;
  const double x0 = 0.15;
  const double tip = (1.0 - x0) - (1.0 - std::pow(x0, 4)) / 4.0;
  const double square = (1.0 - x0) - (1.0 - std::pow(x0, 4)) / 2.0 + (1.0 - std::pow(x0, 7)) / 7.0;
  const double stiffness = GJ / R * square / (tip * tip);
  const auto blade = make_blade(plank(2.0 * R, 0.06)).value();
  EXPECT_TRUE(near(1.0 / blade->torsion.compliance_rad_per_Nm, stiffness,
                   stated(0.005 * stiffness, "20 rings for the integral")));
}

TEST(Torsion, HalfTheThicknessIsEightTimesAsSoft) {
  const double thick = make_blade(plank(0.3, 0.08)).value()->torsion.compliance_rad_per_Nm;
  const double thin = make_blade(plank(0.3, 0.04)).value()->torsion.compliance_rad_per_Nm;
  EXPECT_TRUE(near(thin, 8.0 * thick, stated(1e-9 * thin, "t cubed")));
}

// Aeroelastic similarity: the same tip speed twists a blade of any size by the same angle.
TEST(Torsion, TwistAsksForTipSpeedNotForSize) {
  const auto twist = [](double diameter_m) {
    const auto blade = make_blade(plank(diameter_m, 0.05)).value();
    RotorValidity validity;
    RotorConditions c;
    c.omega_radps = 60.0 / (0.5 * diameter_m);
    const DiscFlow flow = disc_flow(*blade, 1, c, validity);
    std::array<double, kRing_count> u, v{};
    u.fill(4.0);
    return wanted_tip_twist_rad(*blade, flow, disc_loads(*blade, flow, u, v));
  };
  EXPECT_NE(twist(0.2), 0.0);
  EXPECT_TRUE(near(twist(0.2), twist(0.4), stated(1e-9, "round-off")));
}

// GWS 9x4.7 [UiucProp]: thrust ends at J 0.62 at 4008 rpm and at 0.55 at 6815 rpm.
TEST(Torsion, SoftBladesLoseTheirLastThrustEarlierAtSpeed) {
  const auto last_J = [](bool soft, double rpm) {
    PropellerDescription d = hobbyking_10x4_5(section("bw3"), section("e63"));
    if (!soft) d.material = {};
    const auto blade = make_blade(d).value();
    double J = 0.3;
    while (propeller_coefficients(blade, rpm * 0.10471975512, J).CT > 0.0 && J < 1.0) J += 0.005;
    return J;
  };
  EXPECT_LT(last_J(true, 6815) - last_J(true, 4008), -0.02);
  EXPECT_GT(last_J(false, 6815) - last_J(false, 4008), -0.005);
}

}  // namespace
}  // namespace whirl::plant
