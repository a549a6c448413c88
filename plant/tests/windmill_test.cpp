// Propellers that the air drives: a fall with all bridges open, and what a drive does to a rotor that
// turns backward. Energy from nowhere is a bug.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/near.hpp"
#include "base/random.hpp"
#include "plant/motor/averaged_motor.hpp"
#include "plant/rotor/rotor.hpp"
#include "plant/rotor/tests/test_blades.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;
constexpr double kStep_s = 1e-3;

double imbalance_J(const MotorBooks& b) {
  return b.electrical_in_J - b.copper_J - b.diode_J - b.no_load_J - b.magnetic_J - b.kinetic_J -
         b.air_J;
}
double scale_J(const MotorBooks& b) {
  return std::abs(b.electrical_in_J) + b.copper_J + std::abs(b.magnetic_J) + std::abs(b.kinetic_J) +
         std::abs(b.air_J) + b.no_load_J;
}

TEST(Windmill, FrictionHoldsAShaftThatTheAirTurnsTooWeakly) {
  AveragedMotor motor(MotorParams{});
  const double friction_Nm = 0.01005;
  for (const double torque_Nm : {-0.99 * friction_Nm, 0.99 * friction_Nm}) {
    for (int k = 0; k < 100; ++k) motor.step({.diode = true}, {0.0, torque_Nm}, 1e-4);
    EXPECT_EQ(motor.speed_radps(), 0.0) << torque_Nm;
  }
}

// Open bridge: J dw/dt = -(air torque) - friction, either way.
TEST(Windmill, AShaftOnAnOpenBridgeFollowsTheAirLessFriction) {
  const double friction_Nm = 0.01005, torque_Nm = 0.02;
  for (const double sign : {-1.0, 1.0}) {
    AveragedMotor motor(MotorParams{});
    for (int k = 0; k < 1000; ++k) {
      motor.step({.bus_V = 16.0, .diode = true}, {0.0, -sign * torque_Nm}, 1e-4);
    }
    const double want = sign * (torque_Nm - friction_Nm) / 3.752e-5 * 0.1;
    EXPECT_TRUE(near(motor.speed_radps(), want, stated(1e-9, "the implicit midpoint is exact")));
    EXPECT_EQ(motor.current_A(), 0.0);
  }
}

TEST(Windmill, FrictionStopsABackwardShaftAndNeverTurnsIt) {
  AveragedMotor motor(MotorParams{});
  motor.set_speed(-100.0);
  double before = -100.0;
  for (int k = 0; k < 20000; ++k) {
    motor.step({.bus_V = 16.0, .diode = true}, {}, 1e-4);
    ASSERT_LE(motor.speed_radps(), 0.0);
    ASSERT_GE(motor.speed_radps(), before);
    before = motor.speed_radps();
  }
  EXPECT_EQ(before, 0.0);
}

TEST(Windmill, ADriveTurnsABackwardRotorRound) {
  for (const bool diode : {false, true}) {
    AveragedMotor motor(MotorParams{});
    motor.set_speed(-300.0);
    for (int k = 0; k < 3000; ++k) {
      motor.step({.bus_V = 16.0, .duty = 0.3, .diode = diode}, {1e-7, 0.0}, 1e-4);
    }
    EXPECT_GT(motor.speed_radps(), 300.0);
  }
}

// Any speed, drive and load: the books close, and friction only ever takes.
TEST(Windmill, BooksCloseWhicheverWayTheShaftTurns) {
  RandomStream random(5, "windmill");
  const auto any = [&](double most) { return most * (2.0 * random.uniform() - 1.0); };
  for (int run = 0; run < 2000; ++run) {
    AveragedMotor motor(MotorParams{});
    motor.set_speed(any(600.0));
    for (int k = 0; k < 50; ++k) {
      const Drive drive{.bus_V = 12.0 + any(4.0),
                        .duty = random.bits() % 2 ? 0.0 : random.uniform(),
                        .diode = random.bits() % 2 == 0};
      const ShaftLoad load{1e-7 * random.uniform(), any(0.05)};
      const MotorBooks books = motor.step(drive, load, 1.25e-4);
      ASSERT_TRUE(near(imbalance_J(books), 0.0, round_off(20, scale_J(books) + 10.0)))
          << run << " " << k;
      ASSERT_GE(books.no_load_J, -1e-15) << run << " " << k;
      ASSERT_GE(books.copper_J, -1e-15);
    }
  }
}

// A rotor takes from the stream no less than what it hands to the shaft, and of a stream along its
// axis no more than 16/27 [Betz] with what its wake adds below a windmill's loading.
TEST(Windmill, ARotorTakesItsShaftPowerFromTheStream) {
  for (const double rising_mps : {2.0, 5.0, 10.0, 15.0, 20.0}) {
    for (double omega = -1000.0; omega <= 1000.0; omega += 100.0) {
      Rotor rotor(hobbyking(), 1);
      RotorConditions c;
      c.omega_radps = omega;
      c.v_AP_P_mps = {0.0, 0.0, rising_mps};
      for (int k = 0; k < 400; ++k) rotor.step(c, kStep_s);
      const RotorLoads l = rotor.step(c, kStep_s);
      const double from_stream_W = -l.f_P_N.dot(c.v_AP_P_mps);
      EXPECT_GE(from_stream_W + l.shaft_power_W, 0.0) << rising_mps << " " << omega;
      const double stream_W = 0.5 * 1.225 * disc_area_m2(*hobbyking()) * std::pow(rising_mps, 3);
      EXPECT_GT(l.shaft_power_W, -16.0 / 27.0 * stream_W) << rising_mps << " " << omega;
    }
  }
}

struct Fall {
  Vehicle v;
  double fastest_mps = 0.0, slowest_radps = 0.0, most_gained_J = -1e9;

  explicit Fall(const VehicleParams& params)
      : v(params, blade_element_rotors(hobbyking(), params.airframe), 1) {
    v.place({0, 0, -60}, Eigen::Quaterniond::Identity(), Vector3d::Zero(), Vector3d::Zero());
  }
  double energy_J() const {
    const VehicleState& s = v.state();
    const VehicleParams p = hp_quad();
    const Vector3d& w = s.w_WB_B_radps;
    double sum = 0.5 * 0.9 * s.v_WB_W_mps.squaredNorm() - 0.9 * 9.80665 * s.p_WB_W_m.z() +
                 0.5 * w.dot(p.airframe.inertia_kgm2.cwiseProduct(w));
    for (const MotorState& m : s.motors) sum += 0.5 * 3.752e-5 * m.speed_radps * m.speed_radps;
    return sum;
  }
  void run(double until_m) {
    double before_J = energy_J();
    for (int k = 0; k < 20000 && -v.state().p_WB_W_m.z() > until_m; ++k) {
      v.step(kStep_s);
      fastest_mps = std::max(fastest_mps, v.state().v_WB_W_mps.norm());
      slowest_radps = std::min(slowest_radps, v.state().motors[0].speed_radps);
      most_gained_J = std::max(most_gained_J, energy_J() - before_J);
      before_J = energy_J();
    }
  }
};

TEST(Windmill, AFallWithAllMotorsCutEndsAtAPlausibleSpeed) {
  Fall fall(hp_quad());
  fall.run(1.0);
  const VehicleState& s = fall.v.state();
  // Frame 325 cm2 and four stopped propellers of some 25 cm2 x 1.3 each: sqrt(2 m g / (rho 455 cm2)).
  EXPECT_TRUE(near(s.v_WB_W_mps.z(), 17.8, stated(1.5, "drag of a stopped blade known to 20 %")));
  EXPECT_LT(fall.most_gained_J, 1e-9);
  EXPECT_LT(s.motors[0].speed_radps, -10.0);   // the rising air pushes against the pitch
  EXPECT_GT(s.motors[0].speed_radps, -200.0);  // and friction takes nearly all of it
  EXPECT_EQ(s.motors[0].bus_current_A, 0.0);
}

// The same with shafts that turn freely: the air spins them up backward and pays for it.
TEST(Windmill, FreePropellersSpinUpBackwardAndSlowTheFall) {
  VehicleParams params = hp_quad();
  params.motor.no_load_current_A = 0.0;
  Fall stiff(hp_quad()), free(params);
  stiff.run(1.0);
  free.run(1.0);
  EXPECT_LT(free.slowest_radps, -300.0);
  EXPECT_LT(free.v.state().v_WB_W_mps.z(), stiff.v.state().v_WB_W_mps.z());
  EXPECT_LT(free.most_gained_J, 1e-9);
}

// Cut in flight, propellers forward: they run down and the fall is the same in the end.
TEST(Windmill, PropellersCutAtSpeedRunDown) {
  Fall fall(hp_quad());
  for (int i = 0; i < 4; ++i) fall.v.set_motor_speed(i, 413.0);
  fall.run(1.0);
  EXPECT_LT(fall.v.state().motors[0].speed_radps, 50.0);
  EXPECT_LT(fall.most_gained_J, 1e-9);
}

// One rotor's thrust over a second of a descent that a hand holds, its motor at hover's duty.
std::vector<double> thrusts_in_descent(double descent_mps, std::uint64_t seed) {
  const VehicleParams params = hp_quad();
  Vehicle v(params, blade_element_rotors(hobbyking(), params.airframe), seed);
  for (int i = 0; i < 4; ++i) v.set_motor_speed(i, 413.0), v.command(i, {0.345, Freewheel::diode});
  std::vector<double> thrusts_N;
  double height_m = 50.0;
  for (int k = 0; k < 2000; ++k) {
    height_m -= descent_mps * kStep_s;
    v.carry({.p_WB_W_m = {0, 0, -height_m}, .v_WB_W_mps = {0, 0, descent_mps}});
    v.step(kStep_s);
    if (k >= 1000) thrusts_N.push_back(v.state().motors[0].thrust_N);
  }
  return thrusts_N;
}

double sigma_share(const std::vector<double>& x) {
  double mean = 0.0, squares = 0.0;
  for (const double y : x) mean += y / static_cast<double>(x.size());
  for (const double y : x) squares += (y - mean) * (y - mean) / static_cast<double>(x.size());
  return std::sqrt(squares) / mean;
}

TEST(VortexRingInFlight, ThrustFluctuatesThereByTheSeedAndNowhereElse) {
  const double landing = sigma_share(thrusts_in_descent(0.8, 1));
  const auto ring = thrusts_in_descent(5.4, 1);
  EXPECT_LT(landing, 0.005);
  EXPECT_GT(sigma_share(ring), 0.01);
  EXPECT_LT(sigma_share(ring), 0.02);
  EXPECT_EQ(ring, thrusts_in_descent(5.4, 1));
  EXPECT_NE(ring, thrusts_in_descent(5.4, 2));
}

}  // namespace
}  // namespace whirl::plant
