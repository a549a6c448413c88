// The firmware's control core on a plant motor, through what the native ESC senses and drives.
// Oracles: thesis sec. 5.4 (50 ms thrust rise, 20 A); the ESC protocol. Thrust is the thesis's static fit,
// torque that of a propeller with a figure of merit of 0.69. How long a start takes is held against the
// image (harness/tests/native_start_test.cpp); arming, silence and latches are judged where they live
// (firmware/esc/tests).
#include "harness/flight/native_esc.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/near.hpp"
#include "base/rpm.hpp"
#include "harness/flight/tests/milliseconds.hpp"
#include "io_bridges/protocols/esc_codec.hpp"
#include "plant/motor/averaged_motor.hpp"

namespace whirl::flight {
namespace {

using io::EscFlag;
using io::EscMode;

EscParams in_mode(fw::esc::Mode mode) {
  EscParams params;
  params.calibration.mode = mode;
  return params;
}

struct Stand {
  NativeEsc esc;
  plant::AveragedMotor motor{plant::MotorParams{}};
  plant::MotorState state;
  double bus_V = 16.4;
  double drag_Nm_s2 = 2.0e-7;
  double rising_Nm = 0.0;    // of air from below, against the sense of the rotor
  double extra_bus_A = 0.0;  // what the shunt reads beyond the motor
  bool hidden = false;       // the rotor shows no crossings
  std::int64_t t_ns = 0;
  double worst_winding_A = 0.0;

  explicit Stand(const EscParams& params = {}) : esc(params, 1, 1) {}

  double thrust_N() const {
    const double rpm = rpm_of(motor.speed_radps());
    return 1.789e-7 * rpm * rpm - 1.4715e-4 * rpm;
  }
  void step() {
    plant::MotorState read = state;
    read.bus_current_A += extra_bus_A;
    if (hidden) read.speed_radps = 0.0;
    const plant::MotorCommand command = esc.step(t_ns, read, bus_V);
    const bool diode = command.freewheel == plant::Freewheel::diode;
    double charge_C = 0.0;
    for (int i = 0; i < 8; ++i) {
      charge_C +=
          motor.step({bus_V, command.duty, diode}, {drag_Nm_s2, rising_Nm}, 1.25e-4).bus_charge_C;
      worst_winding_A = std::max(worst_winding_A, std::abs(motor.current_A()));
    }
    state.speed_radps = motor.speed_radps();
    state.bus_current_A = charge_C / 1e-3;
    t_ns += kMs;
  }
  // Set-points at 50 Hz, as the master sends them.
  void command(std::uint16_t v, int ms) {
    for (int i = 0; i < ms; ++i) {
      if (i % 20 == 0) esc.write(v);
      step();
    }
  }
  void thrust(double newton, int ms) {
    command(io::setpoint_of_value(EscMode::thrust_by_rpm, newton), ms);
  }
  void arm() { command(0, 520); }
  bool flag(std::uint8_t bit) const { return (esc.status().flags & bit) != 0; }
};

double time_to_ms(const std::vector<double>& record, double level) {
  const auto passed =
      std::find_if(record.begin(), record.end(), [=](double x) { return x >= level; });
  return static_cast<double>(passed - record.begin());
}

struct StepFigures {
  double rise_ms, response_ms, overshoot, final_N;
};

StepFigures thrust_step(double from_N, double to_N, double bus_V = 16.4) {
  Stand stand;
  stand.arm();
  stand.bus_V = bus_V;
  stand.thrust(from_N, 2000);
  const double before = stand.thrust_N();
  std::vector<double> record;
  for (int i = 0; i < 25; ++i) {
    stand.esc.write(io::setpoint_of_value(EscMode::thrust_by_rpm, to_N));
    for (int ms = 0; ms < 20; ++ms) stand.step(), record.push_back(stand.thrust_N());
  }
  const double change = record.back() - before;
  const double highest = *std::max_element(record.begin(), record.end());
  const double t90 = time_to_ms(record, before + 0.9 * change);
  return {t90 - time_to_ms(record, before + 0.1 * change), t90 + 1.0,
          (highest - record.back()) / change, record.back()};
}

TEST(NativeEsc, ThrustRisesWithinFiftyMilliseconds) {
  const StepFigures step = thrust_step(2.0, 3.2);
  RecordProperty("rise_ms", std::to_string(step.rise_ms));
  EXPECT_LE(step.rise_ms, 50.0);
  EXPECT_GE(step.rise_ms, 20.0);  // 20 A and the inertia allow no less
  EXPECT_LE(step.response_ms, 70.0);
  EXPECT_LE(step.overshoot, 0.10);
  EXPECT_TRUE(near(step.final_N, 3.2, stated(0.03, "1 %: set-point step, slow integral")));
}

TEST(NativeEsc, RisesAsFastOnATiredPack) {
  for (const double bus_V : {15.7, 14.0}) {
    const StepFigures step = thrust_step(2.0, 3.2, bus_V);
    EXPECT_LE(step.rise_ms, 50.0) << bus_V;
    EXPECT_LE(step.response_ms, 70.0) << bus_V;
  }
}

TEST(NativeEsc, LargeStepIsBoundByTwentyAmperesInTheWinding) {
  Stand stand;
  stand.arm();
  stand.thrust(0.8, 1000);
  stand.worst_winding_A = 0.0;
  stand.thrust(4.0, 500);
  EXPECT_LE(stand.worst_winding_A, 22.0);  // the bound is the firmware's belief
  EXPECT_GT(stand.worst_winding_A, 16.0);  // and the means are used
  EXPECT_GT(stand.thrust_N(), 3.9);
}

TEST(NativeEsc, BeyondItsMeansItSaturatesAndRecoversAtOnce) {
  Stand stand;
  stand.arm();
  stand.bus_V = 12.5;         // above the floor
  stand.drag_Nm_s2 = 5.0e-7;  // 8 N, the set-point's full scale, would want 27 A in the winding
  stand.thrust(8.0, 3000);
  EXPECT_TRUE(stand.flag(EscFlag::kSaturated));
  EXPECT_LT(stand.thrust_N(), 7.5);
  stand.thrust(2.0, 600);
  EXPECT_FALSE(stand.flag(EscFlag::kSaturated));
  EXPECT_TRUE(near(stand.thrust_N(), 2.0, stated(0.06, "3 %: no wound-up integral")));
}

TEST(NativeEsc, RpmModeHoldsItsSpeedAndTellsIt) {
  Stand stand(in_mode(fw::esc::Mode::speed));
  stand.arm();
  stand.command(io::setpoint_of_value(EscMode::rpm, 4000.0), 2000);
  EXPECT_TRUE(near(rpm_of(stand.motor.speed_radps()), 4000.0, stated(10, "slow integral")));
  EXPECT_TRUE(near(stand.esc.status().speed_rpm, rpm_of(stand.motor.speed_radps()),
                   stated(2.0, "one tick of the timer is 0.9 RPM")));
}

TEST(NativeEsc, DutyModeIsOpenLoop) {
  Stand stand(in_mode(fw::esc::Mode::duty));
  stand.arm();
  stand.command(io::setpoint_of_value(EscMode::duty, 40.0), 2000);
  // 40 % of 16.4 V - 60 % of a diode's 0.7 V = Ke w + (R + commutation) (i0 + k w^2 / Kt), with the
  // drop of commutation (3/pi) p w L/2 per ampere: solved by halving for w.
  const plant::MotorParams& m = stand.motor.params();
  const double given_V = 0.4 * 16.4 - 0.6 * m.diode_drop_V, k = m.torque_constant_NmpA;
  double w = 0.0;
  for (double step = 512.0; step > 1e-6; step *= 0.5) {
    const double ohm = stand.motor.resistance_ohm() +
                       3.0 / std::numbers::pi * m.pole_pairs * (w + step) * m.inductance_H / 2.0;
    const double current_A = m.no_load_current_A + 2.0e-7 * (w + step) * (w + step) / k;
    if (k * (w + step) + ohm * current_A < given_V) w += step;
  }
  EXPECT_TRUE(
      near(stand.motor.speed_radps(), w, stated(0.015 * w, "heat of the ripple, PWM counts")));
}

TEST(NativeEsc, TellsTheCurrentAtTheShuntWhateverItsOffset) {
  EscParams params;
  params.shunt.gain_tolerance = 0.0;
  params.shunt.warm_up_A = 0.0;
  for (const double offset_A : {4.1, 4.6}) {
    params.shunt.offset_low_A = params.shunt.offset_high_A = offset_A;
    Stand stand(params);
    stand.arm();
    stand.thrust(2.2, 2000);
    double told_A = 0.0, true_A = 0.0;
    for (int i = 0; i < 200; ++i) {
      if (i % 20 == 0) stand.esc.write(io::setpoint_of_value(EscMode::thrust_by_rpm, 2.2));
      stand.step();
      told_A += stand.esc.status().bus_current_A / 200, true_A += stand.state.bus_current_A / 200;
    }
    EXPECT_TRUE(near(told_A, true_A, stated(0.05, "one count is 32 mA; the offset wanders 10 mA")));
    EXPECT_GT(true_A, 1.0);
  }
}

TEST(NativeEsc, ArmsByTheVoltageThatItMeasures) {
  Stand stand;
  stand.bus_V = 15.69;  // one count of the converter is 6 mV
  stand.arm();
  EXPECT_FALSE(stand.esc.armed());
  EXPECT_TRUE(stand.flag(EscFlag::kUnderVoltage));
  stand.bus_V = 15.71;
  stand.arm();
  EXPECT_TRUE(stand.esc.armed());
  EXPECT_FALSE(stand.flag(EscFlag::kUnderVoltage));
}

TEST(NativeEsc, StopsHalfASecondAfterTheLastWrite) {
  Stand stand;
  stand.arm();
  stand.thrust(3.0, 981);  // the last write falls on 980 ms
  for (int ms = 0; ms < 498; ++ms) stand.step();
  EXPECT_TRUE(stand.esc.armed());
  for (int ms = 0; ms < 3; ++ms) stand.step();
  EXPECT_FALSE(stand.esc.armed());
  stand.thrust(3.0, 1000);
  EXPECT_FALSE(stand.esc.armed());
  EXPECT_LT(stand.motor.speed_radps(), 100.0);
}

TEST(NativeEsc, ARotorThatStrikesIsSwitchedOffAndSaysSo) {
  Stand stand;
  stand.arm();
  stand.thrust(2.0, 1000);
  stand.motor.block();
  stand.thrust(2.0, 100);
  EXPECT_TRUE(stand.flag(EscFlag::kDesync));  // it tries for 1.5 s
  stand.thrust(2.0, 1500);
  EXPECT_FALSE(stand.esc.armed());
  EXPECT_TRUE(stand.flag(EscFlag::kDesync));
  EXPECT_EQ(stand.state.bus_current_A, 0.0);
}

TEST(NativeEsc, AnOverCurrentOfTheBusLatchesUntilTwentyFiveZeros) {
  Stand stand;
  stand.arm();
  stand.thrust(2.0, 1000);
  stand.extra_bus_A = 40.0;  // at the shunt; the limit is 22 A in the mean for 3 ms
  stand.thrust(2.0, 20);
  EXPECT_FALSE(stand.esc.armed());
  EXPECT_TRUE(stand.flag(EscFlag::kOverCurrent));
  stand.extra_bus_A = 0.0;
  stand.thrust(2.0, 1000);
  EXPECT_FALSE(stand.esc.armed());
  stand.command(0, 2000);
  EXPECT_TRUE(stand.esc.armed());
}

TEST(NativeEsc, JoinsARotorThatStillTurnsInsteadOfStartingIt) {
  Stand stand;
  stand.arm();
  stand.thrust(3.0, 1000);
  stand.command(0, 100);  // coasts
  const double coasting_radps = stand.motor.speed_radps();
  ASSERT_GT(coasting_radps, 200.0);
  stand.esc.write(io::setpoint_of_value(EscMode::thrust_by_rpm, 3.0));
  for (int ms = 0; ms < 30; ++ms) stand.step();
  EXPECT_TRUE(stand.flag(EscFlag::kTurning));
  EXPECT_GT(stand.motor.speed_radps(), coasting_radps);
}

TEST(NativeEsc, TriesALostRotorAgainUntilItIsFound) {
  Stand stand;
  stand.arm();
  stand.thrust(2.0, 1000);
  stand.hidden = true;
  stand.thrust(2.0,
               600);  // one start of 176 ms has waited its 300 ms in vain; the next is under way
  EXPECT_TRUE(stand.esc.armed());
  EXPECT_TRUE(stand.flag(EscFlag::kDesync));
  EXPECT_FALSE(stand.flag(EscFlag::kTurning));
  EXPECT_EQ(stand.state.bus_current_A, 0.0);  // held off meanwhile, not driven on
  stand.hidden = false;
  stand.thrust(2.0, 1000);
  EXPECT_TRUE(stand.flag(EscFlag::kTurning));
  EXPECT_FALSE(stand.flag(EscFlag::kDesync));
  EXPECT_TRUE(near(stand.thrust_N(), 2.0, stated(0.1, "back at its work")));
}

TEST(NativeEsc, TheCoreGetsTheLatestSectorAndWhetherTheRotorSlows) {
  Stand stand;
  stand.arm();
  stand.thrust(1.0, 1000);
  EXPECT_FALSE(stand.esc.core().sensed().slowing);
  stand.thrust(4.0, 20);  // some 8 rad/s more in each millisecond
  const fw::esc::Sensed& sensed = stand.esc.core().sensed();
  const double true_radps = stand.motor.speed_radps();
  EXPECT_LT(true_radps - static_cast<double>(sensed.latest_radps),
            0.6 * (true_radps - static_cast<double>(sensed.speed_radps)));
  EXPECT_FALSE(sensed.slowing);
  stand.thrust(4.0, 500);
  stand.motor.block();
  stand.thrust(4.0, 2);
  EXPECT_TRUE(sensed.slowing);  // the next crossing is overdue
}

TEST(NativeEsc, CutItStaysStopped) {
  Stand stand;
  stand.arm();
  stand.thrust(2.0, 1000);
  stand.esc.cut();
  stand.thrust(2.0, 500);
  stand.command(0, 2000);
  EXPECT_FALSE(stand.esc.armed());
  EXPECT_LT(stand.motor.speed_radps(), 50.0);
}

// Falling with its motors off, the vehicle has its propellers turned backward by the air.
TEST(NativeEsc, StartsARotorThatTheAirTurnsBackward) {
  Stand stand;
  stand.rising_Nm = 0.012;
  stand.arm();
  ASSERT_LT(stand.motor.speed_radps(), -20.0);
  stand.thrust(2.0, 1500);
  EXPECT_GT(stand.motor.speed_radps(), 300.0);
  EXPECT_TRUE(near(stand.thrust_N(), 2.0, stated(0.2, "as from standstill")));
  EXPECT_LT(stand.worst_winding_A, 60.0);
}

}  // namespace
}  // namespace whirl::flight
