// Where the pack's energy goes: books of the whole vehicle, checked at every step.
#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "base/random.hpp"
#include "plant/rotor/rotor.hpp"
#include "plant/rotor/tests/test_blades.hpp"
#include "plant/tests/quadratic_rotor.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;
constexpr double kStep_s = 1e-3;

double spent_J(const EnergyBooks& e) {
  return e.battery_J + e.avionics_J + e.short_J + e.copper_J + e.diode_J + e.no_load_J +
         e.magnetic_J + e.kinetic_J + e.air_J;
}
double throughput_J(const EnergyBooks& e) {
  return std::abs(e.chemical_J) + std::abs(e.battery_J) + e.copper_J + e.diode_J +
         std::abs(e.magnetic_J) + std::abs(e.kinetic_J) + std::abs(e.air_J);
}

// 100,000 states, any duty, attitude, speed, freewheeling, wind and rotor speed; a winding short in one run of four.
TEST(VehicleEnergy, EveryJouleOfThePackIsAccountedForInAnyState) {
  RandomStream random(12, "energy");
  auto any = [&](double most) { return most * (2.0 * random.uniform() - 1.0); };
  VehicleParams params = hp_quad();
  params.air.dryden.wind_at_6m_mps = 20.0;
  for (int run = 0; run < 500; ++run) {
    Vehicle v(params, quadratic_rotors(params.airframe), static_cast<std::uint64_t>(run));
    v.place({any(5), any(5), any(3)}, Eigen::Quaterniond(any(1), any(1), any(1), any(1)),
            {any(20), any(20), any(20)}, {any(50), any(50), any(50)});
    for (int i = 0; i < 4; ++i) v.set_motor_speed(i, 900.0 * random.uniform());
    for (int k = 0; k < 200; ++k) {
      for (int i = 0; i < 4; ++i) {
        const Freewheel freewheel = random.bits() % 2 ? Freewheel::diode : Freewheel::synchronous;
        v.command(i, {any(1.2), freewheel, run % 4 == 0 ? 20.0 * i : 0.0});
      }
      v.step(kStep_s);
      const EnergyBooks& e = v.state().energy;
      ASSERT_TRUE(near(spent_J(e), e.chemical_J,
                       stated(1e-8 * throughput_J(e) + 1e-9, "bus voltage agreed to 10 nV")))
          << run << " " << k;
      ASSERT_GE(e.copper_J, -1e-20);
      ASSERT_GE(e.diode_J, 0.0);
      ASSERT_GE(e.no_load_J, -1e-12);
    }
  }
}

// Straight up through rising air, so that nothing turns: pack, losses, shafts, rotors, wind and body.
TEST(VehicleEnergy, ClimbInAnUpdraftBalancesFromThePackToTheHeight) {
  VehicleParams params = hp_quad();
  params.airframe.rotor_drag_spm = 0.0;
  params.airframe.drag_area_m2.setZero();
  RotorSet inner = blade_element_rotors(hobbyking(), params.airframe), watched(inner.size());
  double shaft_J = 0.0, to_air_J = 0.0, ideal_J = 0.0;
  Vector3d force = Vector3d::Zero();
  for (int i = 0; i < 4; ++i) {
    watched[i] = [&, i](const RotorConditions& c, double dt_s) {
      const RotorLoads l = inner[i](c, dt_s);
      const double on_airframe_W = l.f_P_N.dot(c.v_AP_P_mps);
      shaft_J += l.shaft_power_W * dt_s;
      to_air_J += (l.shaft_power_W - on_airframe_W) * dt_s;
      ideal_J += l.thrust_N * l.induced_velocity_mps * dt_s;
      force += l.f_P_N;
      return l;
    };
  }
  Vehicle v(params, watched, 1);
  const Vector3d wind{0.0, 0.0, -1.5};  // upwards
  v.set_steady_wind(wind);
  v.place({0, 0, -50}, Eigen::Quaterniond::Identity(), {0, 0, -1}, Vector3d::Zero());
  for (int i = 0; i < 4; ++i) {
    v.set_motor_speed(i, 413.0);
    v.command(i, {0.36, Freewheel::diode});
  }
  const double mass = params.airframe.mass_kg;
  auto body_J = [&] {
    const VehicleState& s = v.state();
    return 0.5 * mass * s.v_WB_W_mps.squaredNorm() - mass * 9.80665 * s.p_WB_W_m.z();
  };
  const double before_J = body_J();
  double given_J = 0.0, air_J = 0.0, wind_J = 0.0;
  for (int k = 0; k < 1000; ++k) {
    force.setZero();
    v.step(kStep_s);
    const EnergyBooks& e = v.state().energy;
    given_J += e.chemical_J - (spent_J(e) - e.air_J);
    air_J += e.air_J;
    wind_J += force.dot(wind) * kStep_s;
  }
  ASSERT_LT(v.state().w_WB_B_radps.norm(), 1e-6);
  EXPECT_GT(air_J, 50.0);
  EXPECT_GT(wind_J, 5.0);
  EXPECT_TRUE(near(given_J, air_J, stated(1e-6 * air_J, "closed at every step")));
  EXPECT_TRUE(near(air_J, shaft_J, stated(0.005 * air_J, "loads are held over a step")));
  // What the shafts and the wind gave stays in the air or lifts the body.
  EXPECT_TRUE(near(shaft_J + wind_J, to_air_J + body_J() - before_J,
                   stated(0.005 * shaft_J, "forces are held over a step")));
  // What stays in the air is the wake (thrust x induced velocity) and the blades' drag.
  EXPECT_GT(to_air_J, ideal_J);
  EXPECT_LT(to_air_J, 2.0 * ideal_J);
}

}  // namespace
}  // namespace whirl::plant
