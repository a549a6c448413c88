// The world of a flight, flown by a pilot of our own (piloted_flight.hpp).
#include "base/near.hpp"
#include "harness/flight/tests/piloted_flight.hpp"

namespace whirl::flight {
namespace {

TEST(FlightWorld, StandsStillUntilItIsFlown) {
  Flight flight;
  flight.run(1.0);
  EXPECT_EQ(flight.value("esc_armed_3"), 1.0);  // the pilot's zeros arm
  EXPECT_TRUE(near(flight.value("height"), 0.11, stated(0.002, "gear settles")));
  EXPECT_EQ(flight.value("on_ground"), 1.0);
  EXPECT_GT(flight.value("bus_voltage"), 15.7);
}

// In the air, nose to the east and moving: a body that is thrown follows its parabola.
TEST(FlightWorld, StartsWhereThePlanSays) {
  FlightParams params = hp_quad_file();
  params.place.start =
      Start{.p_WB_W_m = {1.0, -1.0, -2.5},
            .q_WB = Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ())),
            .v_WB_W_mps = {0.5, 0.0, -1.0},
            .w_WB_B_radps = {0.0, 0.0, 1.0},
            .motor_speed_radps = 100.0};
  Flight flight(params);
  EXPECT_EQ(flight.value("height"), 2.5);
  EXPECT_EQ(flight.value("north"), 1.0);
  EXPECT_EQ(flight.value("climb"), 1.0);
  EXPECT_EQ(flight.value("rate_z"), 1.0);
  EXPECT_EQ(flight.value("speed_3"), 100.0);
  EXPECT_TRUE(near(flight.value("yaw"), 0.5 * M_PI, round_off(8, 2.0)));
  flight.run(0.2);
  const double want_m = 2.5 + 0.2 - 0.5 * 9.80665 * 0.2 * 0.2;
  EXPECT_TRUE(near(flight.value("height"), want_m, stated(0.02, "drag and slow propellers")));
  EXPECT_TRUE(near(flight.value("north"), 1.1, stated(0.005, "drag")));
}

TEST(FlightWorld, HoversWhereItsPilotWants) {
  Flight flight;
  flight.run(1.0);
  flight.height_m = 1.1;
  flight.run(8.0);
  double worst_height = 0.0, worst_offset = 0.0, worst_tilt = 0.0;
  for (int i = 0; i < 3000; ++i) {
    flight.step();
    worst_height = std::max(worst_height, std::abs(flight.value("height") - 1.1));
    worst_offset = std::max(worst_offset, std::hypot(flight.value("north"), flight.value("east")));
    worst_tilt = std::max(worst_tilt, flight.value("tilt"));
  }
  EXPECT_LT(worst_height, 0.05);
  EXPECT_LT(worst_offset, 0.10);
  EXPECT_LT(worst_tilt, 0.05);
  // Four thrusts carry 900 g; hover is 3950 RPM by the thesis's static fit.
  double thrust_N = 0.0;
  for (const char* name : {"thrust_1", "thrust_2", "thrust_3", "thrust_4"}) {
    thrust_N += flight.value(name);
  }
  EXPECT_TRUE(near(thrust_N, 0.9 * 9.80665, stated(0.3, "small motions")));
  EXPECT_TRUE(near(flight.value("speed_1"), 3950 * 0.10472, stated(20.0, "5 %, static fit")));
}

TEST(FlightWorld, AGustPushesItDownwind) {
  Flight flight;
  flight.run(1.0);
  flight.height_m = 1.1;
  flight.run(8.0);
  const double before_m = flight.value("east");
  ASSERT_TRUE(
      plan::disturb(flight.world, table("{ east = '2 m/s', duration = '1 s' }"), flight.t_ns).ok());
  flight.run(0.5);
  EXPECT_TRUE(near(flight.value("wind_east"), 2.0, round_off(4, 2)));
  flight.run(0.5);
  EXPECT_GT(flight.value("east"), before_m + 0.01);
}

// Nose north: a wind from the north tilts the discs back, one from the east to the left, each of them; what the
// advancing sides add differs in sign with the spins, and is smaller.
TEST(FlightWorld, ItsDiscsTiltAwayFromTheWind) {
  for (const char* axis : {"back", "left"}) {
    Flight flight;
    flight.run(1.0);
    flight.height_m = 1.1;
    flight.run(4.0);
    const bool back = std::string(axis) == "back";
    const auto gust =
        back ? "{ north = '-4 m/s', duration = '1 s' }" : "{ east = '-4 m/s', duration = '1 s' }";
    ASSERT_TRUE(plan::disturb(flight.world, table(gust), flight.t_ns).ok());
    flight.run(0.2);
    double away = 0.0, across = 0.0;
    for (const std::string n : {"_1", "_2", "_3", "_4"}) {
      EXPECT_GT(flight.value("flapping_cone" + n), 1e-3) << n;
      EXPECT_GT(flight.value("flapping_" + std::string(axis) + n), 0.0) << n;
      away += flight.value("flapping_" + std::string(axis) + n);
      across += flight.value(std::string("flapping_") + (back ? "left" : "back") + n);
    }
    EXPECT_GT(away, 4e-4) << axis;
    EXPECT_LT(std::abs(across), 0.3 * away) << axis;
  }
}

TEST(FlightWorld, TellsTheBoardWhatItFeels) {
  Flight flight;
  flight.run(1.0);
  io::Reader reader(flight.sensed.bytes());
  int states = 0;
  bool motion_seen = false;
  while (reader.next()) {
    if (reader.header().kind == io::Kind::esc_state) ++states;
    if (reader.header().kind != io::Kind::body_motion) continue;
    motion_seen = true;
    const auto motion = reader.as<io::BodyMotion>();
    EXPECT_TRUE(
        near(motion.specific_force_B_mps2[2], -9.80665, stated(0.2, "settled on its gear")));
    EXPECT_GT(motion.magnetic_field_B_T[0], 0.0);  // nose north
  }
  EXPECT_TRUE(motion_seen);
  EXPECT_EQ(states, 4);
}

io::BodyMotion motion_of(const io::Batch& sensed) {
  for (io::Reader r(sensed.bytes()); r.next();) {
    if (r.header().kind == io::Kind::body_motion) return r.as<io::BodyMotion>();
  }
  ADD_FAILURE() << "no body_motion";
  return {};
}

TEST(FlightWorld, TellsTheBoardWhereItIsAndHowFast) {
  Flight flight;
  flight.run(1.0);  // the zeros that arm
  flight.height_m = 1.0;
  flight.run(1.0);
  const io::BodyMotion motion = motion_of(flight.sensed);
  EXPECT_LT(motion.p_WB_W_m[2], -0.05);    // up is against z
  EXPECT_LT(motion.v_WB_W_mps[2], -0.05);  // on its way
  EXPECT_EQ(-motion.p_WB_W_m[2], flight.value("height"));
  EXPECT_EQ(-motion.v_WB_W_mps[2], flight.value("climb"));
  EXPECT_EQ(motion.p_WB_W_m[0], flight.value("north"));
  EXPECT_EQ(motion.p_WB_W_m[1], flight.value("east"));
  EXPECT_GT(motion.q_WB[0], 0.99);  // near upright, nose north
}

TEST(FlightWorld, TellsTheBoardThrustsAndCurrents) {
  Flight flight;
  flight.run(1.0);  // the zeros that arm
  flight.height_m = 1.0;
  flight.run(1.0);
  const io::BodyMotion motion = motion_of(flight.sensed);
  double bridges_A = 0.0;
  for (int motor = 1; motor <= 4; ++motor) {
    const std::string n = "_" + std::to_string(motor);
    EXPECT_GT(motion.rotor_thrust_N[motor - 1], 1.0);  // it climbs
    EXPECT_EQ(motion.rotor_thrust_N[motor - 1], flight.value("thrust" + n));
    EXPECT_EQ(motion.rotor_bus_current_A[motor - 1], flight.value("bus_current" + n));
    bridges_A += motion.rotor_bus_current_A[motor - 1];
  }
  EXPECT_EQ(motion.rotor_thrust_N[4], 0.0);  // of motors that are not there
  EXPECT_TRUE(near(motion.battery_current_A, bridges_A + 0.25, stated(1e-6, "and the avionics")));
}

// Standing nose north in a wind that blows to the east, it moves through the air to the left.
TEST(FlightWorld, TellsTheBoardHowItMovesThroughTheAir) {
  Flight flight;
  ASSERT_TRUE(plan::disturb(flight.world, table("{ east = '2 m/s', duration = '5 s' }"), 0).ok());
  flight.run(2.0);
  const io::BodyMotion motion = motion_of(flight.sensed);
  EXPECT_TRUE(near(motion.v_AB_B_mps[1], -2.0, stated(0.05, "stands on its gear")));
  EXPECT_TRUE(near(motion.v_AB_B_mps[0], 0.0, stated(0.05, "stands on its gear")));
  EXPECT_TRUE(near(motion.v_WB_W_mps[1], 0.0, stated(0.05, "stands on its gear")));
}

TEST(FlightWorld, AJetBlowsWhereItIsAndNowhereElse) {
  Flight flight;
  flight.run(0.1);
  ASSERT_TRUE(plan::disturb(flight.world,
                            table("{ jet = { up = '3.5 m/s', radius = '35 cm', north = '2 m' } }"),
                            0)
                  .ok());
  flight.run(0.1);
  EXPECT_EQ(flight.value("wind_down"), 0.0);  // 2 m away
  ASSERT_TRUE(
      plan::disturb(flight.world, table("{ jet = { up = '1 m/s', radius = '35 cm' } }"), 0).ok());
  flight.run(0.1);
  EXPECT_TRUE(near(flight.value("wind_down"), -1.0, round_off(4, 1)));
}

TEST(FlightWorld, RefusesCommandsItDoesNotUnderstand) {
  Flight flight;
  for (const char* text :
       {"{ fly = true }", "{ takeoff = '1.1 kg' }", "{ takeoff = '-1 m' }",
        "{ position = { north = '1 m' }, speed = '0 m/s' }", "{ parameter = { value = 1 } }",
        "{ parameter = { name = '', value = 1 } }",
        "{ parameter = { name = 'SEVENTEEN_LETTERS', value = 1 } }",
        "{ parameter = { name = 'A', value = 1e300 } }",
        "{ parameter = { name = 'A', value = '1 m' } }", "{}", "{ land = false }",
        "{ land = true, takeoff = '1 m' }", "{ position = { north = '1 m' }, figure_8 = {} }",
        "{ attitude = { roll = '1 deg' }, thrust = '50 %', velocity = {} }",
        "{ duty = '10 %', power = '10 W' }"}) {
    EXPECT_FALSE(plan::command(flight.world, table(text), 0).ok()) << text;
  }
  for (const char* text : {"{ jet = { up = '3 m/s' } }", "{ jet = { radius = '1 m' } }",
                           "{ jet = { up = '3 m/s', radius = '5 cm', edge = '20 cm' } }"}) {
    EXPECT_FALSE(plan::disturb(flight.world, table(text), 0).ok()) << text;
  }
  EXPECT_FALSE(plan::disturb(flight.world, table("{ duration = '1 s' }"), 0).ok());
}

// An ESC, its signals and its messages for each motor of a hexa, which a board numbers from 1 to 6.
TEST(FlightWorld, HasAnEscForEachMotor) {
  FlightParams params = hp_quad_file();
  plant::AirframeParams& airframe = params.vehicle.airframe;
  airframe.rotors.push_back({{0.2, 0.2, -0.03}, +1});
  airframe.rotors.push_back({{-0.2, -0.2, -0.03}, -1});
  FlightWorld world(params, 1);
  EXPECT_TRUE(SignalTable(world.signals()).find("thrust_6").has_value());
  EXPECT_FALSE(SignalTable(world.signals()).find("thrust_7").has_value());
  FaultSpec stop;
  stop.kind = "esc_stopped";
  stop.place = fault_at::Motor{6};
  EXPECT_TRUE(world.take_fault(stop).value());
  stop.place = fault_at::Motor{7};
  EXPECT_FALSE(world.take_fault(stop).ok());
  io::Batch happened, sensed;
  world.step(0, happened, sensed);
  for (std::uint16_t motor = 1; motor <= 6; ++motor) {
    happened.add(io::Kind::esc_setpoint, motor, 0, io::EscSetpoint{0, 1, {}, 0});
  }
  sensed.clear();
  world.step(kMs, happened, sensed);
  std::vector<int> told;
  for (io::Reader r(sensed.bytes()); r.next();) {
    if (r.header().kind == io::Kind::esc_state) told.push_back(r.header().port);
  }
  EXPECT_EQ(told, (std::vector<int>{1, 2, 3, 4, 5, 6}));
}

// What only a stand can do is no word of a flight; the key stands in the complaint.
TEST(FlightWorld, WhatAStandDoesIsRefusedByItsKey) {
  Flight flight;
  const auto refusal = [&](const std::string& text) {
    const auto done = plan::command(flight.world, table(text), 0);
    return done ? "none" : done.error().message();
  };
  EXPECT_EQ(refusal("{ thrust = '2 N' }"), "plan.lua:1: thrust: means nothing to a flight");
  EXPECT_EQ(refusal("{ brake = '1 N m' }"), "plan.lua:1: brake: means nothing to a flight");
  EXPECT_EQ(refusal("{ line = 'status' }"), "plan.lua:1: line: means nothing to a flight");
  const auto gust = plan::disturb(flight.world, table("{ duration = '0 s', east = '1 m/s' }"), 0);
  ASSERT_FALSE(gust.ok());
  EXPECT_EQ(gust.error().message(), "plan.lua:1: duration: must be positive");
}

// What nobody on board can hear would be no command, and the plan would show nothing.
TEST(FlightWorld, CommandsThatTheBoardCannotHearAreRefused) {
  const auto refusal = [](BoardEars ears, const std::string& text) {
    FlightParams params = hp_quad_file();
    params.ears = ears;
    FlightWorld world(params, 1);
    const auto done = plan::command(world, table(text), 0);
    return done ? "none" : done.error().message();
  };
  const std::string sticks = "{ rc = { roll = '10 %' } }", take_off = "{ takeoff = '1 m' }";
  EXPECT_NE(refusal({.radio = true, .receiver = false}, sticks).find("has no receiver"),
            std::string::npos);
  EXPECT_EQ(refusal({.radio = true, .receiver = false}, take_off), "none");
  EXPECT_NE(refusal({.radio = false, .receiver = true}, take_off).find("has no radio"),
            std::string::npos);
  EXPECT_EQ(refusal({.radio = false, .receiver = true}, sticks), "none");
}

TEST(FlightWorld, ItsFaultsActAndAreReportedOnlyThen) {
  Flight flight;
  const auto fault = [&](std::uint32_t number, const char* kind, const FaultPlace& place,
                         double value) {
    FaultSpec spec;
    spec.number = number;
    spec.kind = kind;
    spec.place = place;
    spec.start_ns = 2000 * kMs;
    spec.end_ns = 2500 * kMs;
    spec.value = value;
    return flight.world.take_fault(spec);
  };
  // What its ESC is called on the board says nothing; whose it is does.
  const fault_at::Device right{"right_esc", 3, 0x2A, 2}, nobodys{"esc2", 3, 0x2A, 0};
  EXPECT_TRUE(fault(1, "capture_lost", {}, 0).value());
  EXPECT_TRUE(fault(2, "supply_dip", {}, 3.0).value());
  EXPECT_TRUE(fault(3, "esc_stopped", right, 0).value());
  EXPECT_FALSE(fault(4, "i2c_nack", right, 0).value());
  EXPECT_FALSE(fault(5, "esc_stopped", nobodys, 0).ok());
  EXPECT_FALSE(fault(6, "esc_stopped", fault_at::Motor{5}, 0).ok());
  EXPECT_FALSE(fault(6, "winding_short", fault_at::Motor{5}, 30.0).ok());
  EXPECT_FALSE(fault(6, "winding_short", right, 0.0).ok());  // it would act and change nothing
  EXPECT_FALSE(fault(6, "capture_moved", {}, 0.0).ok());
  EXPECT_FALSE(fault(6, "capture_turned", right, 1.0).ok());
  flight.run(1.0);
  flight.height_m = 0.02;
  flight.run(0.9);
  EXPECT_TRUE(flight.world.applied_faults().empty());
  EXPECT_EQ(flight.value("esc_armed_2"), 1.0);
  const double before_V = flight.value("bus_voltage");
  flight.run(0.3);
  auto applied = flight.world.applied_faults();
  std::sort(applied.begin(), applied.end());
  EXPECT_EQ(applied, (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(flight.value("esc_armed_2"), 0.0);
  EXPECT_TRUE(near(flight.value("bus_voltage"), before_V - 3.0, stated(0.5, "load changes")));
}

}  // namespace
}  // namespace whirl::flight
