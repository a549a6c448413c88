// Rotors that nobody in the house has flown: other sizes, blade counts, pitches, materials, speeds.
#include "base/near.hpp"
#include "plant/rotor/tests/test_blades.hpp"

namespace whirl::plant {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Shape {
  int blades;
  double diameter_in, pitch_in, thickness;
  BladeMaterial material;
};
const Shape kShapes[] = {{3, 5.0, 4.5, 0.10, {}},           {2, 18.0, 6.0, 0.10, kCarbon},
                         {2, 10.0, 10.0, 0.10, kWood},      {2, 10.0, 4.5, 0.05, kNylon},
                         {4, 6.0, 3.0, 0.08, kGlass_nylon}, {1, 9.0, 5.0, 0.12, {}}};

// Constant geometric pitch over a slow flyer's planform.
std::shared_ptr<const Blade> blade_of(const Shape& s) {
  PropellerDescription d;
  d.place = d.name = "shape";
  d.blade_count = s.blades;
  d.diameter_m = s.diameter_in * 0.0254;
  d.mass_kg = 0.01;
  d.material = s.material;
  d.thickness_over_chord = s.thickness;
  for (const auto& [x, c] :
       {std::pair{0.15, 0.12}, {0.3, 0.18}, {0.5, 0.21}, {0.75, 0.18}, {1.0, 0.05}}) {
    d.stations.push_back({x, c, std::atan(s.pitch_in / (kPi * s.diameter_in * x))});
  }
  if (s.thickness > 0.085) {
    d.sections = {{0.2, section("naca4412")}};
  } else {
    d.sections = {{0.2, section("bw3")}, {0.9, section("naca6409")}};
  }
  return make_blade(d).value();
}

TEST(Shapes, HoverIsSaneFrom500To30000Rpm) {
  for (const Shape& s : kShapes) {
    const Rotor rotor(blade_of(s), 1);
    for (const double rpm : {500.0, 2000.0, 6000.0, 30000.0}) {
      if (rpm / 60.0 * kPi * s.diameter_in * 0.0254 > 290.0)
        continue;  // compressible: out of range
      const RotorLoads l = rotor.steady(hover(rpm));
      EXPECT_FALSE(l.validity.not_converged) << s.diameter_in << " " << rpm;
      EXPECT_GT(l.thrust_N, 0.0);
      EXPECT_GT(l.shaft_torque_Nm, 0.0);
      EXPECT_LT(l.figure_of_merit, 0.85) << s.diameter_in << " " << rpm;
      EXPECT_GT(l.figure_of_merit, 0.15) << s.diameter_in << " " << rpm;
    }
  }
}

TEST(Shapes, ObliqueFlowToThreeTenthsDragsAndCarries) {
  for (const Shape& s : kShapes) {
    const Rotor rotor(blade_of(s), 1);
    RotorConditions c = hover(60.0 * 60.0 / (kPi * s.diameter_in * 0.0254));  // tip speed 60 m/s
    double last = 0.0;
    for (const double mu : {0.05, 0.1, 0.2, 0.3}) {
      c.v_AP_P_mps.x() = mu * 60.0;
      const RotorLoads l = rotor.steady(c);
      EXPECT_FALSE(l.validity.not_converged) << s.diameter_in << " " << mu;
      EXPECT_GT(l.thrust_N, 0.0);
      EXPECT_GT(-l.f_P_N.x(), last) << s.diameter_in << " " << mu;
      last = -l.f_P_N.x();
    }
  }
}

// Down through the vortex ring into the windmill: thrust without jumps, torque changes sign once.
TEST(Shapes, DescentIsSmooth) {
  for (const Shape& s : kShapes) {
    const Rotor rotor(blade_of(s), 1);
    RotorConditions c = hover(60.0 * 60.0 / (kPi * s.diameter_in * 0.0254));
    const double still = rotor.steady(c).thrust_N;
    double before = still;
    for (double v = 0.2; v < 20.0; v += 0.2) {
      c.v_AP_P_mps.z() = v;
      const RotorLoads l = rotor.steady(c);
      EXPECT_TRUE(near(l.thrust_N, before, stated(0.06 * still, "no jump")))
          << s.diameter_in << " " << v;
      before = l.thrust_N;
    }
  }
}

TEST(Shapes, TurningBackwardsIsFlaggedAndFinite) {
  RotorConditions c = hover(-3000.0);
  const RotorLoads l = Rotor(blade_of(kShapes[0]), -1).steady(c);
  EXPECT_TRUE(l.validity.backward);
  EXPECT_TRUE(l.f_P_N.allFinite());
}

}  // namespace
}  // namespace whirl::plant
