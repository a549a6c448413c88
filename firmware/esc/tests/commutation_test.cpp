#include "firmware/esc/core/commutation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/near.hpp"

namespace fw::esc {
namespace {

using whirl::near;
using whirl::stated;

constexpr double kPi = std::numbers::pi;
constexpr int kBus_counts = 2640;  // 16.4 V

// A 950 Kv motor with 7 pole pairs and a 10 x 4.5 propeller, written here from the physics: trapezoidal
// back-EMF with 120 degree flats, two phases in series, current without lag, no reversal (diodes).
// Phase A's flat begins where step 0 ought to begin. The floating phase is shown every 50 us.
class TestMotor {
 public:
  void run(Commutation& commutation, double voltage_V, double duration_s) {
    const auto end = ticks_ + static_cast<std::uint32_t>(duration_s / kTick_s);
    for (; ticks_ < end; ++ticks_) {
      turn(voltage_V);
      if (pending_ && static_cast<Ticks>(ticks_) == due_) {
        pending_ = false;
        bridge_ = commutation.step();
        note_error();
        commutation.on_commutated(static_cast<Ticks>(ticks_));
      }
      if (ticks_ % 100 == 0) sample(commutation);
    }
  }
  void sample(Commutation& commutation) {
    const auto now = static_cast<Ticks>(ticks_);
    const auto before = middles_of(commutation);
    const Commutation::Order order = commutation.on_sample(now, floating_counts(), kBus_counts);
    if (pending_ && middles_of(commutation) != before) {
      ++lessons;
      least_ahead_ticks = std::min(least_ahead_ticks, static_cast<Ticks>(due_ - now));
    }
    apply(order);
  }
  void apply(const Commutation::Order& order) {
    if (!order.commutate) return;
    const auto next = static_cast<Ticks>(ticks_ + 1);
    const bool past = static_cast<Ticks>(order.at - next) > 0x8000;
    due_ = past ? next : order.at;
    pending_ = true;
  }
  void seize() { speed = 0.0, seized_ = true; }

  double speed = 0.0;  // mechanical, rad/s
  double angle = 0.0;  // electrical
  double noise_counts = 0.0;
  std::array<double, 3> reads_more{};  // of each phase's divider, as a share
  double load_Nm = 0.0;
  double worst_error_deg = 0.0;
  double current_A = 0.0;
  int lessons = 0;                   // samples in which a middle was learnt,
  Ticks least_ahead_ticks = 0xFFFF;  // and how soon after one the commutation came

 private:
  static constexpr double kTick_s = 0.5e-6, kKt = 0.01005, kR = 0.16, kJ = 3.752e-5;

  // Phase 0, 1, 2: +1 from 0 to 120 degrees, -1 from 180 to 300, linear between.
  double shape(int phase) const {
    const double degrees = (angle - phase * 2.0 * kPi / 3.0) * 180.0 / kPi;
    const double x = degrees - 360.0 * std::floor(degrees / 360.0);
    if (x < 120.0) return 1.0;
    if (x < 180.0) return 1.0 - (x - 120.0) / 30.0;
    if (x < 300.0) return -1.0;
    return -1.0 + (x - 300.0) / 30.0;
  }
  static std::array<int, 6> middles_of(Commutation& commutation) {
    std::array<int, 6> all{};
    for (std::uint8_t step = 0; step < 6; ++step) {
      all[step] = commutation.middles().off(step, 0, 1 << 15);
    }
    return all;
  }
  void turn(double voltage_V) {
    static constexpr int kHigh[] = {0, 0, 1, 1, 2, 2}, kLow[] = {1, 2, 2, 0, 0, 1};
    const double pull = 0.5 * (shape(kHigh[bridge_]) - shape(kLow[bridge_]));
    current_A = std::max(0.0, (voltage_V - kKt * speed * pull) / kR);
    const double friction_Nm = speed > 1.0 ? 0.01005 : 0.0;
    const double drag_Nm = 2.32e-7 * speed * speed + friction_Nm + load_Nm;
    speed += kTick_s / kJ * (kKt * pull * current_A - drag_Nm);
    if (seized_) speed = 0.0;
    angle += 7.0 * speed * kTick_s;
  }
  int floating_counts() const {
    static constexpr int kFloating[] = {2, 1, 0, 2, 1, 0};
    const double emf_V = 0.5 * kKt * speed * shape(kFloating[bridge_]);
    const double noise = noise_counts * std::sin(12.9898 * static_cast<double>(ticks_));
    const double shown =
        (kBus_counts / 2.0 + emf_V / 6.2e-3) * (1.0 + reads_more[kFloating[bridge_]]);
    return static_cast<int>(std::lround(shown + noise));
  }
  void note_error() {
    const double error = std::remainder(angle - bridge_ * kPi / 3.0, 2.0 * kPi) * 180.0 / kPi;
    worst_error_deg = std::max(worst_error_deg, std::abs(error));
  }

  std::uint32_t ticks_ = 0;
  bool pending_ = false, seized_ = false;
  Ticks due_ = 0;
  int bridge_ = 0;
};

struct Turning {
  Commutation commutation;
  TestMotor motor;
  explicit Turning(double load_Nm = 0.0, double noise_counts = 0.0, double off_rad = 0.1)
      : commutation([] {
          CommutationConfig config;
          config.advance_share = 0;
          return config;
        }()) {
    motor.load_Nm = load_Nm;
    motor.noise_counts = noise_counts;
    motor.angle = 2.0 * kPi / 3.0 - off_rad;  // where step 0's field holds the rotor
    motor.apply(commutation.start(0));
    motor.run(commutation, 2.0, 0.4);
  }
};

TEST(Commutation, StartsFromAlignmentAtTwoVolts) {
  Turning t;
  EXPECT_TRUE(t.commutation.in_sync());
  EXPECT_GT(t.motor.speed, 120.0);
  EXPECT_TRUE(
      near(t.commutation.speed_radps(), t.motor.speed, stated(0.02 * t.motor.speed, "ticks")));
}

TEST(Commutation, CommutatesWithinFiveDegreesAtEverySpeed) {
  Turning t;
  for (double voltage_V : {2.0, 4.0, 6.0, 8.0, 10.0, 12.0}) {
    t.motor.run(t.commutation, voltage_V, 0.5);
    t.motor.worst_error_deg = 0.0;
    t.motor.run(t.commutation, voltage_V, 0.2);
    EXPECT_LT(t.motor.worst_error_deg, 5.0) << voltage_V;
    EXPECT_TRUE(near(t.commutation.speed_radps(), t.motor.speed,
                     stated(0.02 * t.motor.speed, "50 us samples in a sector of 150 us or more")));
  }
}

TEST(Commutation, StaysInSyncThroughAStepAtTwentyAmperes) {
  Turning t;
  t.motor.run(t.commutation, 5.0, 0.5);
  t.motor.worst_error_deg = 0.0;
  t.motor.run(t.commutation, 8.0, 0.2);  // 19 A at first: as fast as the limit lets it turn
  EXPECT_LT(t.motor.worst_error_deg, 15.0);
  EXPECT_TRUE(t.commutation.in_sync());
}

TEST(Commutation, ToleratesNoiseOfTheSamples) {
  Turning t(0.0, 4.0);  // an LSB or two of noise is what this board shows
  t.motor.run(t.commutation, 5.0, 0.5);
  t.motor.worst_error_deg = 0.0;
  t.motor.run(t.commutation, 5.0, 0.5);
  EXPECT_LT(t.motor.worst_error_deg, 12.0);
  EXPECT_TRUE(t.commutation.in_sync());
}

// Dividers of 1 % resistors: what rest has not told, the spacing of the crossings does.
TEST(Commutation, LearnsUnevenDividersWhileItTurns) {
  Turning t;
  t.motor.reads_more = {0.03, -0.03, 0.01};
  t.motor.worst_error_deg = 0.0;
  t.motor.run(t.commutation, 2.0, 0.01);
  const double before = t.motor.worst_error_deg;
  t.motor.run(t.commutation, 2.0, 1.0);
  t.motor.worst_error_deg = 0.0;
  t.motor.run(t.commutation, 2.0, 0.1);
  EXPECT_TRUE(t.commutation.in_sync());
  EXPECT_LT(t.motor.worst_error_deg, 1.5);
  EXPECT_GT(before, 8.0);
}

// A sample may take 10 us; one that learns and is interrupted as well would take longer.
TEST(Commutation, LearnsInNoSampleThatACommutationComesInto) {
  Turning t;
  t.motor.reads_more = {0.03, -0.03, 0.01};
  for (const double voltage_V : {2.0, 4.0, 6.0, 8.0, 10.0}) {
    t.motor.run(t.commutation, voltage_V, 0.3);
  }
  EXPECT_GT(t.motor.lessons, 1000);
  EXPECT_GE(t.motor.least_ahead_ticks, 20);
}

// What swings back when a start begins shows a back-EMF of the wrong sign: no crossing.
TEST(Commutation, StartsARotorThatSwingsBackFromItsAlignment) {
  for (const double back_radps : {2.0, 5.0, 8.0}) {
    Commutation commutation{CommutationConfig{}};
    TestMotor motor;
    motor.angle = 2.0 * kPi / 3.0;
    motor.speed = -back_radps;
    motor.apply(commutation.start(0));
    motor.run(commutation, 2.0, 0.12);
    EXPECT_TRUE(commutation.in_sync()) << back_radps;
  }
}

TEST(Commutation, StartsUnderLoad) {
  Turning t(0.02);
  EXPECT_TRUE(t.commutation.in_sync());
}

TEST(Commutation, LosesSyncWhenTheRotorIsSeizedAndSaysSo) {
  Turning t;
  ASSERT_TRUE(t.commutation.in_sync());
  t.motor.seize();
  t.motor.run(t.commutation, 2.0, 0.15);
  EXPECT_FALSE(t.commutation.in_sync());
  EXPECT_EQ(t.commutation.speed_radps(), 0.0f);
  EXPECT_GT(t.commutation.bad_detections(), 0u);
}

TEST(Commutation, StoppedItOrdersNothing) {
  Commutation commutation(CommutationConfig{});
  for (Ticks t = 0; t < 60'000; t = static_cast<Ticks>(t + 100)) {
    EXPECT_FALSE(commutation.on_sample(t, 1000, kBus_counts).commutate);
  }
}

// While a diode still carries the old phase's current, that phase lies at a rail, on the side that a
// crossing would lead to: a start that believed it would run away from the rotor.
TEST(Commutation, PhaseAtARailIsNoCrossing) {
  for (const int rail_counts : {0, kBus_counts, kBus_counts + 100}) {
    Commutation commutation{CommutationConfig{}};
    Ticks t = 1000;
    EXPECT_TRUE(commutation.start(t).commutate);
    commutation.on_commutated(t);
    const auto end = static_cast<Ticks>(t + CommutationConfig{}.align_sector - 100);
    for (; t < end; t = static_cast<Ticks>(t + 100)) {
      ASSERT_FALSE(commutation.on_sample(t, rail_counts, kBus_counts).commutate) << rail_counts;
    }
  }
}

// Of four sectors one that came late and the next, by so much shorter, are no change of speed.
TEST(Pace, ACrossingThatComesLateIsTakenOffByTheNext) {
  const Pace even = pace_of({600, 600, 600, 600, 600, 600}, 0, 0);
  const Pace late = pace_of({600, 600, 600, 630, 570, 600}, 0, 0);
  EXPECT_EQ(late.four, even.four);
  EXPECT_NE(late.sector, even.sector);
  EXPECT_EQ(pace_of({600, 600, 600, 600, 600, 600}, 0, 900).four, 3600u) << "a rotor that is held";
}

}  // namespace
}  // namespace fw::esc
