// The tables of the supervisor, read by a reviewer's rules, and their clockwork.
#include <gtest/gtest.h>

#include <string>

#include "base/near.hpp"
#include "firmware/flight/battery_watch.hpp"
#include "firmware/flight/fence.hpp"
#include "firmware/flight/motor_watch.hpp"
#include "firmware/flight/supervisor.hpp"

namespace fw {
namespace {

using whirl::near;
using whirl::stated;

Reaction in_column(const Rule& rule, Column column) {
  return rule.reactions[static_cast<std::size_t>(column)];
}

TEST(Rules, StopIsForTheGroundAndWhatIsGraveStaysGraveOnTheWayDown) {
  for (const Rule& rule : kRules) {
    const Reaction flying = in_column(rule, Column::autonomous);
    for (const Column column : {Column::autonomous, Column::landing, Column::failsafe}) {
      EXPECT_NE(in_column(rule, column), Reaction::stop) << text_of(rule.reason);
    }
    for (const Column column : {Column::landing, Column::failsafe}) {
      if (flying == Reaction::cut) {
        EXPECT_EQ(in_column(rule, column), Reaction::cut) << text_of(rule.reason);
      }
    }
    EXPECT_NE(in_column(rule, Column::armed), Reaction::land) << text_of(rule.reason);
    EXPECT_NE(in_column(rule, Column::armed), Reaction::failsafe) << text_of(rule.reason);
    EXPECT_NE(in_column(rule, Column::failsafe), Reaction::failsafe) << text_of(rule.reason);
    EXPECT_NE(in_column(rule, Column::failsafe), Reaction::land) << text_of(rule.reason);
  }
}

TEST(Rules, EachConditionIsAnsweredSomewhereAndHasWords) {
  for (const Rule& rule : kRules) {
    EXPECT_NE(in_column(rule, Column::autonomous), Reaction::none) << text_of(rule.reason);
    EXPECT_NE(std::string(text_of(rule.reason)), "");
  }
}

TEST(Commands, NoneTurnsMotorsOffInTheAir) {
  for (const FlightState state :
       {FlightState::flying, FlightState::landing, FlightState::failsafe}) {
    EXPECT_FALSE(allowed(Command::disarm, state));
    EXPECT_FALSE(allowed(Command::arm, state));
    EXPECT_FALSE(allowed(Command::calibrate, state));
  }
  EXPECT_TRUE(allowed(Command::calibrate, FlightState::disarmed));
  EXPECT_FALSE(allowed(Command::calibrate, FlightState::armed));
  EXPECT_TRUE(allowed(Command::arm, FlightState::disarmed));
  EXPECT_FALSE(allowed(Command::take_off, FlightState::disarmed));
  EXPECT_FALSE(allowed(Command::take_off, FlightState::failsafe));
  EXPECT_TRUE(allowed(Command::land, FlightState::flying));
  EXPECT_FALSE(allowed(Command::land, FlightState::armed));
}

Conditions only(Condition condition) {
  Conditions now;
  now.set(condition, true);
  return now;
}

TEST(Supervisor, ReactsAfterTheTimeOfTheRowAndOnlyWhileItHolds) {
  for (const Rule& rule : kRules) {
    Supervisor supervisor;
    const std::uint32_t steps = std::max<std::uint32_t>(1, rule.holds_ms / 5);
    for (std::uint32_t i = 1; i < steps; ++i) {
      EXPECT_EQ(supervisor.step(only(rule.condition), FlightState::flying, 5).reaction,
                Reaction::none)
          << text_of(rule.reason) << " after " << 5 * i << " ms";
    }
    const Decision decision = supervisor.step(only(rule.condition), FlightState::flying, 5);
    EXPECT_EQ(decision.reaction, in_column(rule, Column::autonomous)) << text_of(rule.reason);
    EXPECT_EQ(decision.reason, rule.reason);
    EXPECT_EQ(supervisor.step({}, FlightState::flying, 5).reaction, Reaction::none);
    if (rule.holds_ms > 5) {  // and from the beginning again
      EXPECT_EQ(supervisor.step(only(rule.condition), FlightState::flying, 5).reaction,
                Reaction::none);
    }
  }
}

TEST(Supervisor, DecidesNothingWhileDisarmed) {
  for (const Rule& rule : kRules) {
    Supervisor supervisor;
    EXPECT_EQ(supervisor.step(only(rule.condition), FlightState::disarmed, 60'000).reaction,
              Reaction::none);
    EXPECT_EQ(supervisor.take_warning(), Reason::none);
  }
}

TEST(Supervisor, TheGravestReactionWins) {
  Conditions now = only(Condition::no_setpoints);
  now.set(Condition::no_position, true);
  now.set(Condition::no_pressure, true);
  Supervisor supervisor;
  EXPECT_EQ(supervisor.step(now, FlightState::flying, 5).reason, Reason::no_position);
  now.set(Condition::motor_out, true);
  EXPECT_EQ(supervisor.step(now, FlightState::flying, 5).reaction, Reaction::cut);
}

// An ESC that has tripped has let go of its motor: both hold, and the cause is told.
TEST(Supervisor, AnOverCurrentIsToldBeforeTheMotorThatStandsByIt) {
  Conditions now = only(Condition::motor_out);
  now.set(Condition::esc_over_current, true);
  for (const FlightState state :
       {FlightState::armed, FlightState::flying, FlightState::landing, FlightState::failsafe}) {
    Supervisor supervisor;
    const Decision decision = supervisor.step(now, state, 5);
    EXPECT_EQ(decision.reason, Reason::esc_over_current);
    EXPECT_EQ(decision.reaction, state == FlightState::armed ? Reaction::stop : Reaction::cut);
  }
}

TEST(Supervisor, WarnsOnceEachTimeItBegins) {
  Supervisor supervisor;
  Conditions both = only(Condition::no_pressure);
  both.set(Condition::no_field, true);
  for (int i = 0; i < 10; ++i) supervisor.step(both, FlightState::flying, 5);
  EXPECT_EQ(supervisor.take_warning(), Reason::no_pressure);
  EXPECT_EQ(supervisor.take_warning(), Reason::no_field);
  EXPECT_EQ(supervisor.take_warning(), Reason::none);
  supervisor.step({}, FlightState::flying, 5);
  supervisor.step(only(Condition::no_field), FlightState::flying, 5);
  EXPECT_EQ(supervisor.take_warning(), Reason::no_field);
}

TEST(MotorWatch, AMotorIsOutWhenItsEscSaysSoOnceItHadTimeToStart) {
  constexpr std::uint8_t turning = esc::flag_armed | esc::flag_turning;
  MotorWatch watch;
  for (unsigned i = 0; i < 4; ++i) watch.on_status(i, {400, 4000, turning});
  watch.on_status(2, {0, 0, esc::flag_armed});
  watch.ask(false);
  for (int i = 0; i < 1400; ++i) watch.tick();
  EXPECT_FALSE(watch.out());  // it may still be starting
  for (int i = 0; i < 200; ++i) watch.tick();
  EXPECT_TRUE(watch.out());
  watch.on_status(2, {400, 4000, turning});
  EXPECT_FALSE(watch.out());
  watch.on_status(2, {400, 4000, esc::flag_turning});  // coasting
  EXPECT_TRUE(watch.out());
  watch.ask(false);
  EXPECT_FALSE(watch.out());
}

TEST(BatteryWatch, TellsTheVoltageAtRestUnderCurrent) {
  BatteryWatch battery;
  EXPECT_FALSE(battery.connected());
  for (int i = 0; i < 500; ++i) battery.on_voltage(15.0f, 20.0f, 0.025f);
  EXPECT_TRUE(battery.connected());
  EXPECT_TRUE(near(battery.voltage_V(), 15.0, stated(1e-5, "floats")));
  EXPECT_TRUE(near(battery.rest_V(), 15.5, stated(1e-5, "floats")));
}

TEST(Fence, DrawsInsideByTheMarginAndHasNoLimitWhereNothingIsSaid) {
  const Fence room{2.5f, 2.0f, 3.0f};
  EXPECT_TRUE(room.contains({2.49f, -1.99f, -2.99f}));
  EXPECT_FALSE(room.contains({-2.51f, 0.0f, -1.0f}));
  EXPECT_FALSE(room.contains({0.0f, 2.01f, -1.0f}));
  EXPECT_FALSE(room.contains({0.0f, 0.0f, -3.01f}));
  EXPECT_EQ(room.inside({9.0f, -9.0f, -9.0f}), Vector3(2.1f, -1.6f, -2.6f));
  EXPECT_EQ(room.inside({1.0f, 1.0f, -1.0f}), Vector3(1.0f, 1.0f, -1.0f));
  const Fence none{};
  EXPECT_TRUE(none.contains({1e4f, 1e4f, -1e4f}));
  EXPECT_EQ(none.inside({1e4f, 1e4f, -1e4f}), Vector3(1e4f, 1e4f, -1e4f));
  const Fence narrow{0.1f, 0.1f, 0.1f};  // less than the margin: its middle
  EXPECT_EQ(narrow.inside({1.0f, -1.0f, -1.0f}), Vector3(0.0f, 0.0f, 0.0f));
}

TEST(Fence, ACylinderIsRoundAndBrakesOutwardAlone) {
  const Fence round{.top_m = 30.0f, .radius_m = 50.0f};
  EXPECT_TRUE(round.contains({30.0f, 39.9f, -29.0f}));
  EXPECT_FALSE(round.contains({30.0f, 40.1f, -29.0f}));
  const Vector3 in = round.inside({300.0f, 400.0f, -99.0f});
  EXPECT_TRUE(near(in.x(), 29.76, stated(1e-4, "floats")));
  EXPECT_TRUE(near(in.z(), -29.6, stated(1e-4, "floats")));
  const Vector3 v = round.stoppable({2.0f, 1.0f, 0.0f}, {49.1f, 0.0f, -5.0f}, 1.0f);
  EXPECT_TRUE(near(v.x(), 0.5, stated(1e-4, "floats")));
  EXPECT_TRUE(near(v.y(), 1.0, stated(1e-4, "floats")));
}

TEST(Fence, AVelocityIsBrakedBeforeTheMarginAndTurnedBackBeyondIt) {
  const Fence room{2.5f, 0.0f, 3.0f};
  EXPECT_EQ(room.stoppable({1.0f, 1.0f, 0.0f}, {0.0f, 50.0f, 0.0f}, 1.0f),
            Vector3(1.0f, 1.0f, 0.0f));
  EXPECT_TRUE(near(room.stoppable({1.0f, 0.0f, 0.0f}, {1.6f, 0.0f, 0.0f}, 1.0f).x(), 0.5,
                   stated(1e-5, "floats")));
  EXPECT_TRUE(near(room.stoppable({1.0f, 0.0f, 0.0f}, {2.3f, 0.0f, 0.0f}, 1.0f).x(), -0.2,
                   stated(1e-5, "floats")));
  EXPECT_TRUE(near(room.stoppable({-1.0f, 0.0f, 0.0f}, {2.3f, 0.0f, 0.0f}, 1.0f).x(), -1.0,
                   stated(1e-5, "floats")));
}

// By power a rotor's thrust is as wrong as its current is: one of four is enough.
TEST(MotorWatch, OneWhoseCurrentIsNotWarmCountsInTheModesThatGoByPower) {
  using enum esc::Mode;
  MotorWatch motors;
  for (unsigned i = 0; i < 4; ++i) motors.on_status(i, {0, 0, esc::flag_armed});
  EXPECT_FALSE(motors.not_warm(thrust_by_power));
  for (unsigned cold = 0; cold < 4; ++cold) {
    motors.on_status(cold, {0, 0, esc::flag_armed | esc::flag_uncalibrated});
    EXPECT_TRUE(motors.not_warm(thrust_by_power)) << cold;
    EXPECT_TRUE(motors.not_warm(power)) << cold;
    for (const esc::Mode mode : {duty, speed, thrust_by_speed}) {
      EXPECT_FALSE(motors.not_warm(mode)) << cold;
    }
    motors.on_status(cold, {0, 0, esc::flag_armed});
  }
}

}  // namespace
}  // namespace fw
