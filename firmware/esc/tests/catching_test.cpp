// A rotor that coasts, as the converter sees its terminals with all switches off.
#include "firmware/esc/core/catching.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/near.hpp"
#include "plant/motor/switched_motor.hpp"

namespace fw::esc {
namespace {

using whirl::near;
using whirl::stated;

struct Coasting {
  explicit Coasting(double speed_radps, double angle_rad = 0.0) : motor({}) {
    motor.set_bus(16.4);
    motor.set_bridge({});
    motor.set_speed(speed_radps);
    motor.set_angle(angle_rad);
    catching.start(0);
  }
  Catching::Found step() {
    motor.run(50e-6);
    motor.set_speed(motor.speed_radps());
    now = static_cast<Ticks>(now + 100);
    const auto volts = motor.phase_voltages();
    const auto counts = [&](int k) {
      return static_cast<int>(std::lround(std::max(0.0, volts[k]) / 6.177e-3));
    };
    return catching.on_sample(now, counts(0), counts(1), counts(2));
  }
  Catching::Found until_found(int most_ms) {
    for (ms = 0.0; ms < most_ms; ms += 0.05) {
      if (const auto found = step(); found != Catching::Found::nothing_yet) return found;
    }
    return Catching::Found::nothing_yet;
  }
  whirl::plant::SwitchedMotor motor;
  Catching catching;
  Ticks now = 0;
  double ms = 0.0;
};

// Step s is right from 30 + 60 s electrical degrees on (plant: six_step).
TEST(Catching, FindsWhereTheRotorIsAndHowFast) {
  for (const double speed_radps : {60.0, 150.0, 300.0, 550.0, 800.0}) {
    for (const double angle_rad : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
      Coasting c(speed_radps, angle_rad);
      const double revolution_ms = 1e3 * 2.0 * std::numbers::pi / (7.0 * speed_radps);
      ASSERT_EQ(c.until_found(200), Catching::Found::turning) << speed_radps;
      EXPECT_LT(c.ms, 1.2 * revolution_ms + 0.5);
      EXPECT_EQ(c.catching.step(), whirl::plant::sector_of(c.motor.electrical_angle_rad()));
      const double sector_ticks = 2000.0 * revolution_ms / 6.0;
      EXPECT_TRUE(near(c.catching.sector(), sector_ticks,
                       stated(50.0 + 0.1 * sector_ticks, "half a sample; it slows down")))
          << speed_radps;
    }
  }
}

TEST(Catching, RotorThatStandsIsFoundToStand) {
  Coasting c(0.0);
  EXPECT_EQ(c.until_found(50), Catching::Found::standing);
  EXPECT_TRUE(near(c.ms, 15.0, stated(1.0, "its patience")));
}

TEST(Catching, RotorThatTurnsBackwardIsTold) {
  for (const double speed_radps : {-40.0, -100.0, -300.0}) {
    Coasting c(speed_radps);
    const double revolution_ms = 1e3 * 2.0 * std::numbers::pi / (7.0 * -speed_radps);
    ASSERT_EQ(c.until_found(100), Catching::Found::backward) << speed_radps;
    EXPECT_TRUE(c.catching.backward());
    EXPECT_LT(c.ms, 1.5 * revolution_ms + 0.5);
  }
}

TEST(Catching, RotorThatStandsOrTurnsForwardIsNotToldAsBackward) {
  for (const double speed_radps : {0.0, 60.0, 300.0}) {
    Coasting c(speed_radps);
    EXPECT_NE(c.until_found(200), Catching::Found::backward) << speed_radps;
    EXPECT_FALSE(c.catching.backward());
  }
}

}  // namespace
}  // namespace fw::esc
