// Starts as the image makes them (alignment, probing, start) on the plant's own windings, seen through the worst
// converter and dividers that a board may have.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "firmware/esc/core/commutation.hpp"
#include "firmware/esc/core/sensing.hpp"
#include "plant/motor/switched_motor.hpp"

namespace fw::esc {
namespace {

using whirl::plant::MotorParams;
using whirl::plant::SwitchedMotor;

constexpr double kTick_s = 0.5e-6, kBus_V = 16.8;
constexpr int kPeriod = 100, kOn = 12,
              kProbe_on = 10;  // ticks; 2 V, and a pulse that moves nothing
constexpr std::uint8_t kFloating[] = {2, 1, 0, 2, 1, 0};

MotorParams worst_motor() {
  MotorParams m;
  m.resistance_ohm *= 1.1;
  m.torque_constant_NmpA *= 0.95;
  m.no_load_current_A *= 1.3;
  m.inertia_kgm2 *= 1.05;
  m.phases = {.impedance = {0.03, -0.03, 0.03},
              .emf = {0.01, -0.01, 0.01},
              .sine_share = 1.0,
              .cogging_Nm = 8e-3};
  return m;
}

// The rotor of one start, its bridge, and what the converter shows of it.
class Start {
 public:
  explicit Start(unsigned seed) : random_(seed), motor_(worst_motor()) {
    motor_.set_load({.quadratic_Nm_s2 = 2.3e-7});
    motor_.set_bus(kBus_V);
    motor_.set_angle(std::uniform_real_distribution<>(0.0, 2.0 * std::numbers::pi)(random_));
  }

  void align(double duration_s) {
    step_ = 0;
    for (double t = 0.0; t < duration_s; t += kPeriod * kTick_s) period(kOn, [] {});
  }
  void probe() {
    Middles& middles = commutation_.middles();
    middles.begin_probe();
    for (bool done = false; !done;) {
      step_ = -1;
      run(kPeriod);
      step_ = middles.probed_step();
      period(kProbe_on, [&] { done = middles.probe(floating(), bus()); });
    }
  }
  // Whether commutation follows a rotor of 70 rad/s within that time.
  bool turns_within(double duration_s) {
    order(commutation_.start(Ticks(now_)));
    for (double t = 0.0; t < duration_s; t += kPeriod * kTick_s) {
      period(kOn, [&] { order(commutation_.on_sample(Ticks(now_), floating(), bus())); });
      if (commutation_.in_sync() && motor_.speed_radps() > 70.0) return true;
    }
    return false;
  }

 private:
  template <typename Sample>
  void period(int on, Sample sample) {
    pulse_ = true;
    run(on - 3);
    sample();
    run(3);
    pulse_ = false;
    run(kPeriod - on);
  }
  void run(int ticks) {
    const long end = now_ + ticks;
    while (now_ < end) {
      const long to = ordered_ && due_ < end ? std::max(due_, now_) : end;
      motor_.set_bridge(step_ < 0 ? whirl::plant::Bridge{}
                                  : whirl::plant::six_step(step_, pulse_, false));
      if (to > now_) motor_.run(static_cast<double>(to - now_) * kTick_s);
      now_ = to;
      if (!ordered_ || now_ < due_) continue;
      ordered_ = false;
      step_ = commutation_.step();
      commutation_.on_commutated(Ticks(now_));
    }
  }
  void order(const Commutation::Order& order) {
    if (!order.commutate) return;
    const auto ahead = static_cast<Ticks>(order.at - static_cast<Ticks>(now_));
    due_ = ahead > 0x8000 ? now_ : now_ + ahead;
    ordered_ = true;
  }
  int counts(double volt, double reads_more) {
    const double noise = std::normal_distribution<>(0.0, 3.7)(random_);
    const double shown = volt / static_cast<double>(kVolts_per_count) * (1.0 + reads_more) + noise;
    return std::clamp(static_cast<int>(std::floor(shown)), 0, 4095);
  }
  int floating() {
    static constexpr double kReads_more[] = {0.017, -0.017, 0.017};
    const std::uint8_t phase = kFloating[step_ < 0 ? 0 : step_];
    return counts(motor_.phase_voltages()[phase], kReads_more[phase]);
  }
  int bus() { return counts(kBus_V, -0.017); }

  std::mt19937 random_;
  SwitchedMotor motor_;
  Commutation commutation_{CommutationConfig{}};
  long now_ = 0, due_ = 0;
  int step_ = -1;
  bool pulse_ = false, ordered_ = false;
};

// One in forty may be begun anew (by 300 ms without synchronism, motor_drive.cpp).
TEST(Start, TurnsAWorstMotorFromAnyAngleAtTheFirstAttempt) {
  constexpr int kStarts = 40;
  int turned = 0;
  for (unsigned seed = 0; seed < kStarts; ++seed) {
    Start start(seed);
    start.align(0.143);
    start.probe();
    turned += start.turns_within(0.12) ? 1 : 0;
  }
  EXPECT_GE(turned, kStarts - 1);
}

}  // namespace
}  // namespace fw::esc
