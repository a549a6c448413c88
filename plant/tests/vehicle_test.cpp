#include "plant/vehicle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "base/random.hpp"
#include "plant/observe.hpp"
#include "plant/tests/quadratic_rotor.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;
constexpr double kStep_s = 1e-3;

Vehicle quad(const VehicleParams& params = hp_quad(), std::uint64_t seed = 1) {
  return {params, quadratic_rotors(params.airframe), seed};
}

void all(Vehicle& v, double duty, Freewheel freewheel = Freewheel::synchronous) {
  for (int i = 0; i < 4; ++i) v.command(i, {duty, freewheel});
}

void run(Vehicle& v, double seconds) {
  for (int k = 0; k < std::lround(seconds / kStep_s); ++k) v.step(kStep_s);
}

Vehicle hovering(const VehicleParams& params = hp_quad()) {
  Vehicle v = quad(params);
  v.place({0, 0, -5}, Eigen::Quaterniond::Identity(), Vector3d::Zero(), Vector3d::Zero());
  for (int i = 0; i < 4; ++i) v.set_motor_speed(i, 413.0);
  return v;
}

TEST(Vehicle, RestsOnItsGearUntilThrustExceedsWeight) {
  Vehicle v = quad();
  all(v, 0.1);
  run(v, 2.0);
  EXPECT_TRUE(v.state().on_ground);
  EXPECT_TRUE(near(v.state().p_WB_W_m.z(), -0.11, stated(1e-3, "Bullet's slop")));
  EXPECT_TRUE(near(v.state().specific_force_B_mps2.z(), -9.80665, stated(1e-3, "at rest")));
  all(v, 0.5);
  run(v, 1.0);
  EXPECT_FALSE(v.state().on_ground);
  EXPECT_LT(v.state().p_WB_W_m.z(), -1.0);
}

TEST(Vehicle, AcceleratesUpAsThrustOverMassLessGravity) {
  VehicleParams params = hp_quad();
  params.airframe.drag_area_m2.setZero();
  Vehicle v = hovering(params);
  all(v, 0.4);
  run(v, 0.5);
  const double before = v.state().v_WB_W_mps.z();
  double thrust = 0.0;
  v.step(kStep_s);
  for (const MotorState& m : v.state().motors) thrust += m.thrust_N;
  EXPECT_TRUE(near((v.state().v_WB_W_mps.z() - before) / kStep_s, 9.80665 - thrust / 0.9,
                   round_off(1000, 10.0)));
}

TEST(Vehicle, TellsWhatEachRotorsBladesDo) {
  const VehicleParams params = hp_quad();
  RotorSet rotors;
  for (int i = 1; i <= 4; ++i) {
    rotors.emplace_back([i](const RotorConditions&, double) {
      RotorLoads loads;
      loads.flap_rad = {0.1 * i, 0.01 * i, -0.001 * i};
      return loads;
    });
  }
  Vehicle v(params, rotors, 1);
  v.step(kStep_s);
  for (int i = 1; i <= 4; ++i) {
    const MotorState& m = v.state().motors[static_cast<std::size_t>(i - 1)];
    EXPECT_EQ(m.coning_rad, 0.1 * i);
    EXPECT_EQ(m.flap_back_rad, 0.01 * i);
    EXPECT_EQ(m.flap_left_rad, -0.001 * i);
  }
}

// Torques by geometry [Bangura2017, 4.3 with its signs mended]: tau_x = l (T4 - T2),
// tau_y = l (T1 - T3), and rotors 1 and 3 push the nose to the right.
TEST(Vehicle, EachMotorTurnsTheBodyAsItsPlaceSays) {
  const Vector3d want[4] = {{0, 1, 1}, {-1, 0, -1}, {0, -1, 1}, {1, 0, -1}};
  for (int i = 0; i < 4; ++i) {
    Vehicle v = hovering();
    all(v, 0.30);
    v.command(i, {0.40, Freewheel::synchronous});
    run(v, 0.1);
    const Vector3d w = v.state().w_WB_B_radps;
    for (int axis = 0; axis < 3; ++axis) {
      if (want[i][axis] != 0.0) {
        EXPECT_GT(w[axis] * want[i][axis], 0.01) << i << " " << axis;
      } else {
        EXPECT_LT(std::abs(w[axis]), 0.3 * w.norm()) << i << " " << axis;
      }
    }
  }
}

// In flight the air gives all the torque there is: the momentum of body and rotors about z changes
// by the rotors' aerodynamic torque, however the motors push and brake.
TEST(Vehicle, MotorTorqueIsInternal) {
  VehicleParams params = hp_quad();
  params.airframe.rotor_drag_spm = 0.0;
  Vehicle v = hovering(params);
  const double Ir = hp_quad().motor.inertia_kgm2, Izz = 0.0235;
  auto momentum = [&] {
    double sum = Izz * v.state().w_WB_B_radps.z();
    for (int i = 0; i < 4; ++i) sum += (i % 2 ? Ir : -Ir) * v.state().motors[i].speed_radps;
    return sum;
  };
  const double start = momentum();
  double impulse = 0.0;
  for (int k = 0; k < 200; ++k) {
    for (int i = 0; i < 4; ++i) {
      v.command(i, {i % 2 ? 0.1 : 0.6, Freewheel::synchronous});
    }
    v.step(kStep_s);
    for (int i = 0; i < 4; ++i) {
      impulse += (i % 2 ? -1 : 1) * v.state().motors[i].shaft_torque_Nm * kStep_s;
    }
  }
  EXPECT_TRUE(near(momentum() - start, impulse, stated(1e-12, "round-off")));
  EXPECT_GT(std::abs(impulse), 1e-4);
}

TEST(Vehicle, HoverTakesTheBusCurrentOfTheThesis) {
  VehicleParams params = hp_quad();
  params.battery = lab_supply(16.4, 0.03);
  Vehicle v = hovering(params);
  double duty = 0.3;
  for (int k = 0; k < 20000; ++k) {  // a slow integral on thrust finds the hover's duty
    double thrust = 0.0;
    for (const MotorState& m : v.state().motors) thrust += m.thrust_N;
    duty += 1e-5 * (0.9 * 9.80665 - thrust);
    all(v, duty);
    v.step(kStep_s);
    v.place({0, 0, -5}, Eigen::Quaterniond::Identity(), Vector3d::Zero(), Vector3d::Zero());
  }
  EXPECT_TRUE(near(v.state().motors[0].speed_radps * 30 / M_PI, 3950, stated(30, "static fit")));
  EXPECT_GT(v.state().motors[0].bus_current_A, 1.25);
  EXPECT_LT(v.state().motors[0].bus_current_A, 1.45);
}

TEST(Vehicle, PropellerThatStrikesTheGroundStops) {
  Vehicle v = quad();
  v.place({0, 0, -0.4}, Eigen::Quaterniond(Eigen::AngleAxisd(1.2, Vector3d::UnitX())),
          Vector3d::Zero(), Vector3d::Zero());
  for (int i = 0; i < 4; ++i) v.set_motor_speed(i, 400.0);
  all(v, 0.3);
  run(v, 1.0);
  EXPECT_TRUE(v.state().motors[1].blocked);  // the right one goes down first
  EXPECT_EQ(v.state().motors[1].speed_radps, 0.0);
  EXPECT_EQ(v.state().motors[1].thrust_N, 0.0);
}

TEST(Vehicle, GustPushesDownwind) {
  VehicleParams params = hp_quad();
  params.airframe.rotor_drag_spm = 0.04;
  Vehicle v(params, quadratic_rotors(params.airframe), 1);
  v.place({0, 0, -5}, Eigen::Quaterniond::Identity(), Vector3d::Zero(), Vector3d::Zero());
  for (int i = 0; i < 4; ++i) v.set_motor_speed(i, 413.0);
  all(v, 0.32);
  v.add_gust({.start_s = 0.1, .duration_s = 0.5, .wind_W_mps = {0.0, 2.0, 0.0}});
  run(v, 0.1);
  EXPECT_EQ(v.state().v_WB_W_mps.y(), 0.0);
  v.step(kStep_s);
  run(v, 0.2);
  EXPECT_GT(v.state().v_WB_W_mps.y(), 0.05);
}

TEST(Vehicle, LumpedDragIsItsCoefficientTimesThrustTimesSpeed) {
  VehicleParams params = hp_quad();
  params.airframe.rotor_drag_spm = 0.04;
  params.airframe.drag_area_m2.setZero();
  Vehicle v(params, quadratic_rotors(params.airframe), 1);
  v.place({0, 0, -50}, Eigen::Quaterniond::Identity(), {3.0, 0.0, 0.0}, Vector3d::Zero());
  for (int i = 0; i < 4; ++i) v.set_motor_speed(i, 413.0);
  v.step(kStep_s);
  const Vector3d f = v.state().specific_force_B_mps2;  // a_x = a_z c Vx
  EXPECT_TRUE(near(f.x(), f.z() * 0.04 * 3.0, stated(1e-3, "attitude moves in the step")));
}

TEST(Vehicle, SupplyDipLowersTheBusWhileItLasts) {
  Vehicle v = hovering();
  all(v, 0.3);
  v.dip_supply(3.0, 0.010, 0.005);
  run(v, 0.010);
  const double before = v.state().bus_voltage_V;
  v.step(kStep_s);
  EXPECT_TRUE(near(v.state().bus_voltage_V, before - 3.0, stated(0.6, "less current, less sag")));
  run(v, 0.010);
  EXPECT_TRUE(near(v.state().bus_voltage_V, before, stated(0.2, "recovered")));
}

TEST(Vehicle, SameSeedSameBits) {
  auto end_of = [](std::uint64_t seed) {
    VehicleParams params = hp_quad();
    params.air.dryden.wind_at_6m_mps = 6.0;
    params.airframe.rotor_drag_spm = 0.04;
    Vehicle v(params, quadratic_rotors(params.airframe), seed);
    all(v, 0.4);
    run(v, 1.0);
    return v.state().p_WB_W_m;
  };
  EXPECT_EQ(end_of(1), end_of(1));
  EXPECT_NE(end_of(1), end_of(2));
}

// What the step holds (loads, wind) costs first order: halving it halves the error of a flight.
TEST(Vehicle, FlightConvergesAsTheStepIsHalved) {
  auto flown = [](double dt_s) {
    Vehicle v = hovering();
    for (int i = 0; i < 4; ++i) v.command(i, {0.30 + 0.01 * i, Freewheel::synchronous});
    for (int k = 0; k < std::lround(0.4 / dt_s); ++k) v.step(dt_s);
    return v.state();
  };
  const VehicleState exact = flown(6.25e-5), fine = flown(5e-4), coarse = flown(1e-3);
  const double off_fine = (fine.p_WB_W_m - exact.p_WB_W_m).norm();
  const double off_coarse = (coarse.p_WB_W_m - exact.p_WB_W_m).norm();
  EXPECT_TRUE(near(off_coarse, 0.0, stated(2e-3, "2 mm of 0.4 s of falling about")));
  EXPECT_TRUE(near(off_coarse / off_fine, 2.14, stated(0.3, "(16 - 1) / (8 - 1): first order")));
}

TEST(Vehicle, PushActsWhileItLasts) {
  Vehicle v = hovering();
  v.push({0.0, 0.9, 0.0}, 0.050);
  run(v, 0.1);
  EXPECT_TRUE(near(v.state().v_WB_W_mps.y(), 0.05, stated(0.002, "1 m/s^2 for 50 ms, some drag")));
}

// Rotor by rotor: under a roll rate the right disc goes down into its air, the left one up.
TEST(Vehicle, EachRotorMeetsItsOwnAir) {
  std::array<double, 4> climb{};
  RotorSet rotors(4);
  for (int i = 0; i < 4; ++i) {
    rotors[i] = [&climb, i](const RotorConditions& c, double) {
      climb[i] = -c.v_AP_P_mps.z();
      return RotorLoads{};
    };
  }
  Vehicle v(hp_quad(), rotors, 1);
  v.add_jet({.north_m = 0.25, .radius_m = 0.1, .edge_m = 0.02, .upward_mps = 2.0});
  v.place({0, 0, -5}, Eigen::Quaterniond::Identity(), Vector3d::Zero(), {1.0, 0.0, 0.0});
  v.step(kStep_s);
  EXPECT_TRUE(near(climb[0], -2.0, round_off(16, 2.0)));  // only the front one is over the jet
  EXPECT_TRUE(near(climb[1], -0.25, round_off(16, 1.0)));
  EXPECT_TRUE(near(climb[2], 0.0, round_off(16, 1.0)));
  EXPECT_TRUE(near(climb[3], 0.25, round_off(16, 1.0)));
}

TEST(Vehicle, StaysFiniteUnderAbsurdCommandsStatesAndWinds) {
  RandomStream random(11, "absurd");
  VehicleParams params = hp_quad();
  params.air.dryden.wind_at_6m_mps = 20.0;
  auto any = [&](double most) { return most * (2.0 * random.uniform() - 1.0); };
  for (int run = 0; run < 200; ++run) {
    Vehicle v = quad(params, run);
    v.place({any(5), any(5), any(3)}, Eigen::Quaterniond(any(1), any(1), any(1), any(1)),
            {any(20), any(20), any(20)}, {any(50), any(50), any(50)});
    for (int i = 0; i < 4; ++i) v.set_motor_speed(i, 900.0 * random.uniform());
    for (int k = 0; k < 200; ++k) {
      for (int i = 0; i < 4; ++i) {
        v.command(i, {any(2), random.bits() % 2 ? Freewheel::diode : Freewheel::synchronous});
      }
      v.step(kStep_s);
    }
    ASSERT_TRUE(v.state().p_WB_W_m.allFinite() && v.state().w_WB_B_radps.allFinite()) << run;
    ASSERT_TRUE(std::isfinite(v.state().bus_voltage_V + v.state().battery_current_A)) << run;
    ASSERT_GE(v.state().bus_voltage_V, 0.0);
  }
}

TEST(Vehicle, SensorsSeeItsStateAndFeelTheWind) {
  Vehicle v = hovering();
  all(v, 0.3);
  v.set_steady_wind({0.0, 3.0, 0.0});
  v.step(kStep_s);
  const Truth truth = observe(v.state());
  EXPECT_TRUE(near(truth.v_AB_B_mps.y(), -3.0, stated(0.01, "hardly moved yet")));
  EXPECT_EQ(truth.thrust_N[2], v.state().motors[2].thrust_N);
  EXPECT_LT(truth.static_pressure_Pa, 101325.0 - 55.0);  // 5 m up
  EXPECT_EQ(imu_motion(v.state()).specific_force_B_mps2, v.state().specific_force_B_mps2);
  EXPECT_EQ(imu_motion(v.state()).rotor_speed_radps[3], v.state().motors[3].speed_radps);
}

TEST(VehicleParams, SayWhichBoundIsBroken) {
  VehicleParams params = hp_quad();
  EXPECT_TRUE(validate(params, "hp_quad.lua").ok());
  params.airframe.mass_kg = -0.9;
  const auto result = validate(params, "hp_quad.lua");
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().message().find("mass_kg is -0.9"), std::string::npos);
}

}  // namespace
}  // namespace whirl::plant
