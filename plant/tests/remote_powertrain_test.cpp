// Shafts that somebody else steps, beside the same shafts on the averaged bus.
#include "plant/remote_powertrain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/check.hpp"
#include "base/near.hpp"
#include "plant/averaged_powertrain.hpp"
#include "plant/tests/local_shafts.hpp"
#include "plant/tests/star.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;
constexpr double kStep_s = 1e-3, kAvionics_A = 0.25, kHover_radps = 413.0;

double sum_of(const EnergyBooks& e) {
  return e.battery_J + e.avionics_J + e.copper_J + e.diode_J + e.no_load_J + e.magnetic_J +
         e.kinetic_J + e.capacitor_J + e.air_J + e.exchange_J;
}

// Both powertrains under the same duties and the same loads, each shaft with its propeller on a test
// bench; the pack is the HP quad's.
struct Pair {
  static inline const BatteryParams kPack = lipo_4s_2200();
  std::size_t motors;
  BatteryParams pack;
  AveragedPowertrain averaged{std::vector<MotorParams>(motors), pack, kAvionics_A};
  RemotePowertrain remote{motors, pack, kAvionics_A, MotorParams{}.inertia_kgm2};
  LocalShafts shafts{motors, MotorParams{}};
  PowertrainState here, there;  // averaged and remote
  double chemical_here_J = 0.0, chemical_there_J = 0.0, exchange_J = 0.0;
  double most_A = 0.0;       // of the pack, averaged
  double worst_speed = 0.0;  // difference over speed, of all shafts

  explicit Pair(std::size_t count, const BatteryParams& feed = kPack) : motors(count), pack(feed) {
    here.motors.resize(count);
    there.motors.resize(count);
    shafts.set_speed(kHover_radps);
    const double quadratic = static_torque_Nm(kHover_radps) / (kHover_radps * kHover_radps);
    const std::vector<ShaftLoad> loads(count, ShaftLoad{quadratic, 0.0});
    for (std::size_t i = 0; i < count; ++i) {
      averaged.set_speed(i, kHover_radps);
      remote.set_speed(i, kHover_radps);
    }
    averaged.set_loads(loads);
    remote.set_loads(loads);
  }
  void duty(std::size_t i, double duty) {
    averaged.command(i, {duty, Freewheel::synchronous});
    shafts.set_duty(i, duty);
  }
  void duty_of_all(double value) {
    for (std::size_t i = 0; i < motors; ++i) duty(i, value);
  }
  void run(int steps) {
    chemical_here_J = chemical_there_J = exchange_J = most_A = worst_speed = 0.0;
    for (int k = 0; k < steps; ++k) {
      averaged.step(kStep_s, here);
      shafts.step(remote, kStep_s);
      remote.step(kStep_s, there);
      chemical_here_J += here.energy.chemical_J;
      chemical_there_J += there.energy.chemical_J;
      exchange_J += there.energy.exchange_J;
      most_A = std::max(most_A, std::abs(here.battery_current_A));
      for (std::size_t i = 0; i < motors; ++i) {
        const double off = there.motors[i].speed_radps / here.motors[i].speed_radps - 1.0;
        worst_speed = std::max(worst_speed, std::abs(off));
      }
    }
  }
  void expect_settled_alike() const {
    EXPECT_TRUE(
        near(there.bus_voltage_V, here.bus_voltage_V,
             stated(1e-3, "the source is held over 1 ms, in which it moves by some 10 uV")));
    EXPECT_TRUE(near(there.battery_current_A, here.battery_current_A,
                     stated(1e-4 * here.battery_current_A, "1 mV of 10 V")));
    for (std::size_t i = 0; i < motors; ++i) {
      const double want = here.motors[i].speed_radps;
      EXPECT_TRUE(near(there.motors[i].speed_radps, want, stated(1e-4 * want, "1 mV of 10 V")))
          << i;
    }
  }
};

// Steady currents are exchanged without an error, so what is left is that the source is held over 1 ms.
TEST(RemotePowertrain, HoverIsThatOfTheAveragedBus) {
  Pair pair(4);
  pair.duty_of_all(0.34);
  pair.run(1500);
  pair.run(1000);
  EXPECT_GT(pair.here.battery_current_A, 4.0);
  pair.expect_settled_alike();
  EXPECT_TRUE(near(pair.chemical_there_J, pair.chemical_here_J,
                   stated(1e-4 * pair.chemical_here_J, "as the currents")));
  EXPECT_TRUE(near(pair.exchange_J, 0.0,
                   stated(1e-6 * pair.chemical_here_J, "1e-5 of 16 V, and only while it moves")));
}

// Shafts that start and stop together or one by one: the bound holds at every step, also of the states between.
TEST(RemotePowertrain, TheExchangeIsWithinItsBoundAtEveryStep) {
  Pair pair(4);
  double exchange_J = 0.0;
  for (int k = 0; k < 2000; ++k) {
    if (k % 50 == 0)
      pair.duty(static_cast<std::size_t>(k / 50 % 4), 0.2 + 0.01 * (k * 7 / 50 % 40));
    pair.run(1);
    exchange_J += pair.exchange_J;
    ASSERT_LE(std::abs(exchange_J), pair.remote.bound_J()) << k;
  }
  EXPECT_GT(std::abs(exchange_J), 0.001 * pair.remote.bound_J());
}

// All motors from 30 % to 60 % at once. Limits: half of R dt I^2 for the energy, as the header derives it
// for shafts that change alike; for the speed what (N/2) R dI / N too little voltage in one step, at most
// 1.2 V of 16, can cost a shaft in 1 ms (0.4 %), twice.
TEST(RemotePowertrain, AStepOfAllMotorsKeepsItsEnergyToTheBound) {
  Pair pair(4);
  pair.duty_of_all(0.30);
  pair.run(1500);
  pair.duty_of_all(0.60);
  pair.run(300);
  const double bound_J =
      0.5 * Pair::kPack.series_resistance_ohm * kStep_s * pair.most_A * pair.most_A;
  RecordProperty("exchange_mJ", std::to_string(1e3 * pair.exchange_J));
  EXPECT_GT(pair.most_A, 40.0);
  EXPECT_GT(std::abs(pair.exchange_J), 0.01 * bound_J);  // there is one
  EXPECT_TRUE(near(pair.exchange_J, 0.0, stated(bound_J, "R dt I^2 / 2")));
  EXPECT_TRUE(near(pair.chemical_there_J, pair.chemical_here_J,
                   stated(1e-3 * pair.chemical_here_J, "the bound is 0.05 % of it, twice")));
  EXPECT_LT(pair.worst_speed, 0.01);
  pair.run(1200);
  pair.expect_settled_alike();
}

// One motor alone: it feels k times its own droop at first, the others a step late. Limit: k R dt I^2 of
// its own current.
TEST(RemotePowertrain, AStepOfOneMotorKeepsItsEnergyToTheBound) {
  Pair pair(4);
  pair.duty_of_all(0.30);
  pair.run(1500);
  pair.duty(2, 0.60);
  pair.run(300);
  const double bound_J =
      2.0 * Pair::kPack.series_resistance_ohm * kStep_s * pair.most_A * pair.most_A;
  EXPECT_TRUE(near(pair.exchange_J, 0.0, stated(bound_J, "k R dt I^2")));
  EXPECT_LT(pair.worst_speed, 0.01);
  pair.run(1200);
  pair.expect_settled_alike();
}

// One shaft has its own current at once and nobody else's to wait for.
TEST(RemotePowertrain, OneShaftFollowsTheAveragedBusThroughAStep) {
  Pair pair(1);
  pair.duty_of_all(0.30);
  pair.run(500);
  pair.duty_of_all(0.90);
  pair.run(300);
  EXPECT_LT(pair.worst_speed, 1e-5);  // the source held over 1 ms
  pair.expect_settled_alike();
}

// Twelve motors behind long leads are more conductance than a source of last step's currents can bear.
TEST(RemotePowertrain, TwelveShaftsBehindLongLeadsSettle) {
  Pair pair(12, lab_supply(16.0, 0.1));
  pair.duty_of_all(1.0);
  pair.run(2000);
  double before_V = pair.there.bus_voltage_V;
  for (int k = 0; k < 10; ++k) {
    pair.run(1);
    EXPECT_TRUE(near(pair.there.bus_voltage_V, before_V, stated(1e-4, "settled")));
    before_V = pair.there.bus_voltage_V;
  }
  pair.expect_settled_alike();
}

TEST(RemotePowertrain, ADipLowersWhatEveryShaftIsGiven) {
  RemotePowertrain remote(2, Pair::kPack, 0.0, 1e-5);
  const double before_V = remote.load(1).source_V;
  remote.set_dip(3.0);
  EXPECT_TRUE(near(remote.load(0).source_V, before_V - 3.0, round_off(4, before_V)));
  EXPECT_TRUE(near(remote.load(1).source_V, before_V - 3.0, round_off(4, before_V)));
}

// In flight at a steady hover a lead that loses 3 V takes its current x 3 V, and no energy is made or lost by the
// exchange beyond what the shaft's slowing down makes it, as in a step of one motor.
TEST(RemotePowertrain, ADipOfOneShaftIsItsAloneAndInTheBooks) {
  RemotePowertrain remote(2, Pair::kPack, 0.0, 1e-5);
  const double before_V = remote.load(1).source_V;
  remote.set_shaft_dip(1, 3.0);
  EXPECT_TRUE(near(remote.load(0).source_V, before_V, round_off(4, before_V)));
  EXPECT_TRUE(near(remote.load(1).source_V, before_V - 3.0, round_off(4, before_V)));
  remote.set_shaft_dip(1, 100.0);
  EXPECT_TRUE(
      near(remote.load(1).source_V, 0.0, round_off(4, before_V)));  // it does not turn round

  Pair pair(4);
  pair.duty_of_all(0.34);
  pair.run(1500);
  pair.remote.set_shaft_dip(2, 3.0);
  double taken_J = 0.0, heat_J = 0.0;
  for (int k = 0; k < 1500; ++k) {
    pair.run(1);
    ASSERT_TRUE(near(sum_of(pair.there.energy), pair.there.energy.chemical_J,
                     stated(1e-9, "each shaft's books close")));
    taken_J += std::abs(pair.exchange_J);
    if (k >= 1000) heat_J += pair.there.energy.battery_J;
  }
  const double currents_A2 = pair.there.battery_current_A * pair.there.battery_current_A;
  const double ohmic_J = Pair::kPack.series_resistance_ohm * currents_A2 * 0.5;
  const double lost_J = 3.0 * pair.there.motors[2].bus_current_A * 0.5;
  EXPECT_LT(pair.there.motors[2].speed_radps, 0.85 * pair.there.motors[1].speed_radps);
  EXPECT_LT(taken_J, pair.remote.bound_J());
  EXPECT_TRUE(near(heat_J, ohmic_J + lost_J,
                   stated(0.2 * lost_J, "the pack's relaxation, and what has not settled")));
}

// A state that comes back two steps later was made without what was lost since.
TEST(RemotePowertrain, ADipIsBookedWithTheStatesThatItMade) {
  PowertrainState state;
  state.motors.resize(1);
  RemotePowertrain remote(1, Pair::kPack, 0.0, 1e-5);
  remote.set_age(2);
  const auto loss_J = [&] {
    remote.receive(0, {.source_current_A = 1.0});
    remote.step(kStep_s, state);
    return state.energy.battery_J;
  };
  const Tolerance rest = stated(1e-4, "the pack's own resistance at 1 A");
  remote.set_shaft_dip(0, 3.0);
  EXPECT_TRUE(near(loss_J(), 0.0, rest));
  remote.set_shaft_dip(0, 0.0);
  EXPECT_TRUE(near(loss_J(), 3.0 * kStep_s, rest));
  EXPECT_TRUE(near(loss_J(), 0.0, rest));
}

TEST(RemotePowertrain, AStepNeedsWhatEveryShaftDidAndNoCommands) {
  PowertrainState state;
  state.motors.resize(2);
  const auto of_shafts = [&state](int told) {
    RemotePowertrain remote(2, Pair::kPack, 0.0, 1e-5);
    for (int k = 0; k < told; ++k) remote.receive(static_cast<std::size_t>(k), {});
    remote.step(kStep_s, state);
  };
  base::set_check_handler(base::throw_check_failure);
  EXPECT_THROW(of_shafts(1), base::CheckFailed);
  EXPECT_NO_THROW(of_shafts(2));
  EXPECT_THROW(RemotePowertrain(1, Pair::kPack, 0.0, 1e-5).command(0, {}), base::CheckFailed);
  base::set_check_handler(nullptr);
}

struct Flight {
  VehicleParams params;
  LocalShafts shafts;
  StarPilot pilot{params};
  RemotePowertrain* remote = nullptr;  // the vehicle's
  Vehicle vehicle;
  double exchange_J = 0.0, chemical_J = 0.0;

  explicit Flight(std::size_t rotors)
      : params(star(rotors)), shafts(rotors, params.motor), vehicle(built()) {
    vehicle.place({0, 0, -5}, Eigen::Quaterniond::Identity(), Vector3d::Zero(), Vector3d::Zero());
    shafts.set_speed(kHover_radps);
    for (std::size_t i = 0; i < rotors; ++i)
      vehicle.set_motor_speed(static_cast<int>(i), kHover_radps);
  }
  Vehicle built() {
    auto powertrain =
        std::make_unique<RemotePowertrain>(params.airframe.rotors.size(), params.battery,
                                           params.avionics_current_A, params.motor.inertia_kgm2);
    remote = powertrain.get();
    return {params, quadratic_rotors(params.airframe), std::move(powertrain), 1};
  }
  void run(double seconds, double height_m) {
    for (int k = 0; k < std::lround(seconds / kStep_s); ++k) {
      const std::vector<double> duties = pilot.duties(height_m, vehicle.state());
      for (std::size_t i = 0; i < duties.size(); ++i) shafts.set_duty(i, duties[i]);
      shafts.step(*remote, kStep_s);
      vehicle.step(kStep_s);
      const EnergyBooks& e = vehicle.state().energy;
      ASSERT_TRUE(near(sum_of(e), e.chemical_J, stated(1e-9, "each shaft's books close")));
      exchange_J += e.exchange_J;
      chemical_J += e.chemical_J;
    }
  }
};

class RemoteStar : public ::testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(RemotePowertrain, RemoteStar, ::testing::Values(4, 6, 12));

TEST_P(RemoteStar, HoversOnShaftsThatSomebodyElseStepsAndComesBackFromAPush) {
  Flight flight(GetParam());
  flight.run(4.0, 5.0);
  const VehicleState& s = flight.vehicle.state();
  double thrust_N = 0.0, bus_A = flight.params.avionics_current_A;
  for (const MotorState& m : s.motors) thrust_N += m.thrust_N, bus_A += m.bus_current_A;
  EXPECT_TRUE(near(-s.p_WB_W_m.z(), 5.0, stated(0.05, "no integral in the height law")));
  EXPECT_TRUE(near(thrust_N, flight.params.airframe.mass_kg * 9.80665, stated(0.05, "settled")));
  EXPECT_TRUE(near(s.battery_current_A, bus_A, round_off(100, bus_A)));
  const auto tilt_rad = [&] { return std::acos((s.q_WB * Vector3d::UnitZ()).z()); };
  EXPECT_LT(tilt_rad(), 0.01);

  flight.vehicle.place(s.p_WB_W_m,
                       Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vector3d(1, 1, 0).normalized())),
                       s.v_WB_W_mps, {0.0, 0.0, 0.5});
  flight.run(0.05, 5.0);
  EXPECT_GT(tilt_rad(), 0.1);
  flight.run(4.0, 5.0);
  EXPECT_LT(tilt_rad(), 0.01);
  EXPECT_LT(s.w_WB_B_radps.norm(), 0.02);
  EXPECT_TRUE(near(flight.exchange_J, 0.0,
                   stated(flight.remote->bound_J(), "what the currents' changes allow")));
}

// A propeller that strikes is braked by who steps its shaft, and its motor counts as blocked.
TEST(RemotePowertrain, APropellerThatStrikesTheGroundStopsWithinTenMilliseconds) {
  Flight flight(4);
  flight.vehicle.place({0, 0, -0.30}, Eigen::Quaterniond(Eigen::AngleAxisd(1.2, Vector3d::UnitX())),
                       Vector3d::Zero(), Vector3d::Zero());
  int struck_ms = 0;
  for (int k = 0; k < 300 && struck_ms < 10; ++k) {
    flight.run(kStep_s, 0.3);
    if (flight.vehicle.state().motors[1].blocked) ++struck_ms;
  }
  ASSERT_EQ(struck_ms, 10);
  EXPECT_EQ(flight.vehicle.state().motors[1].speed_radps, 0.0);
  EXPECT_EQ(flight.vehicle.state().motors[1].thrust_N, 0.0);
}

}  // namespace
}  // namespace whirl::plant
