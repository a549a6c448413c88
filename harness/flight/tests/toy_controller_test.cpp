// One more kind of motor controller: from set-points to a flight, a status, a signal and a fault.
#include <gtest/gtest.h>

#include <vector>

#include "base/near.hpp"
#include "base/rpm.hpp"
#include "harness/catalogue/vehicle_file.hpp"
#include "harness/flight/controllers.hpp"
#include "harness/flight/flight_world.hpp"
#include "harness/flight/tests/milliseconds.hpp"
#include "harness/flight/tests/paths.hpp"
#include "harness/flight/tests/toy_controller.hpp"

namespace whirl::flight {
namespace {

ControllerTypes with_toy() {
  ControllerTypes types = controller_types();
  types.push_back(toy_controller_type());  // the one line
  return types;
}

FlightParams toy_vehicle(int more_rotors) {
  auto params =
      catalogue::read_vehicle(std::string(kSourceFolder) + "/test_plans/vehicles/hp_quad.lua");
  EXPECT_TRUE(params.ok());
  params.value().controller = "toy";
  for (int i = 0; i < more_rotors; ++i) {
    params.value().vehicle.airframe.rotors.push_back({{0.2, 0.2, -0.03}, i % 2 == 0 ? +1 : -1});
  }
  return params.value();
}

struct ToyFlight {
  FlightParams params;
  FlightWorld world{params, plant::blade_element_rotors(params.blade, params.vehicle.airframe), 1,
                    with_toy()};
  io::Batch happened, sensed;
  std::int64_t t_ns = 0;

  explicit ToyFlight(int more_rotors = 0) : params(toy_vehicle(more_rotors)) {
    world.step(0, happened, sensed);
  }

  void run(const std::vector<double>& speeds_radps, int ms) {
    for (int i = 0; i < ms; ++i) {
      happened.clear();
      sensed.clear();
      const auto motors = static_cast<std::uint16_t>(speeds_radps.size());
      for (std::uint16_t m = 1; m <= motors; ++m) {
        const auto setpoint = static_cast<std::uint16_t>(speeds_radps[m - 1u] / 1000.0 * 2047.0);
        happened.add(io::Kind::esc_setpoint, m, t_ns, io::EscSetpoint{setpoint, 1, {}, t_ns});
      }
      world.step(t_ns += kMs, happened, sensed);
    }
  }
  std::vector<double> told_rpm() const {
    std::vector<double> rpm;
    for (io::Reader r(sensed.bytes()); r.next();) {
      if (r.header().kind == io::Kind::esc_state) rpm.push_back(r.as<io::EscState>().speed_rpm);
    }
    return rpm;
  }
};

TEST(ToyController, LiftsTheVehicleAndTellsItsSpeed) {
  ToyFlight flight;
  flight.run({500, 500, 500, 500}, 1500);
  const plant::VehicleState& s = flight.world.truth();
  EXPECT_LT(s.p_WB_W_m.z(), -0.5);
  const std::vector<double> told = flight.told_rpm();
  ASSERT_EQ(told.size(), 4u);
  EXPECT_GT(s.motors[2].speed_radps, 400.0);
  EXPECT_TRUE(near(told[2], rpm_of(s.motors[2].speed_radps), stated(5.0, "one step before")));
}

// More speed on motors 1 and 3, which turn counter-clockwise, pushes the nose to the right.
TEST(ToyController, TurnsTheVehicleByItsSetPoints) {
  ToyFlight flight;
  flight.run({500, 420, 500, 420}, 1000);
  EXPECT_GT(flight.world.truth().w_WB_B_radps.z(), 0.1);
}

// What shakes the board's sensors: each rotor, in its place.
TEST(ToyController, TellsTheBoardHowFastEachRotorOfAnOctoTurns) {
  ToyFlight flight(4);
  flight.run({100, 110, 120, 130, 140, 150, 160, 170}, 500);
  const plant::VehicleState& s = flight.world.truth();
  io::Reader reader(flight.sensed.bytes());
  while (reader.next() && reader.header().kind != io::Kind::body_motion) {
  }
  const auto motion = reader.as<io::BodyMotion>();
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(motion.rotor_speed_radps[i], s.motors[i].speed_radps) << i;
    EXPECT_GT(motion.rotor_speed_radps[i], 50.0) << i;
  }
  EXPECT_EQ(motion.rotor_speed_radps[8], 0.0);
}

TEST(ToyController, HasItsOwnSignalsAndIsCutByAFault) {
  ToyFlight flight;
  const SignalTable signals(flight.world.signals());
  ASSERT_TRUE(signals.find("toy_duty_4").has_value());
  EXPECT_FALSE(signals.find("esc_thrust_4").has_value());
  FaultSpec stop;
  stop.kind = "esc_stopped";
  stop.place = fault_at::Motor{4};
  stop.start_ns = 100 * kMs;
  stop.end_ns = 200 * kMs;
  ASSERT_TRUE(flight.world.take_fault(stop).value());
  const auto value = [&](const char* name) {
    std::vector<double> values(flight.world.signals().size());
    flight.world.read(values);
    return values[*signals.find(name)];
  };
  flight.run({300, 300, 300, 300}, 90);
  EXPECT_GT(value("toy_duty_4"), 0.0);
  EXPECT_EQ(value("esc_armed_4"), 1.0);
  flight.run({300, 300, 300, 300}, 50);
  EXPECT_EQ(value("toy_duty_4"), 0.0);
  EXPECT_GT(value("toy_duty_3"), 0.0);
  EXPECT_EQ(value("esc_armed_4"), 0.0);
}

}  // namespace
}  // namespace whirl::flight
