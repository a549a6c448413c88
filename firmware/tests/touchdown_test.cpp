// Landing blind: what stands is told from what flies, around a rigid body of other hands (vehicle_model.hpp).
#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "firmware/control/position_controller.hpp"
#include "firmware/tests/vehicle_model.hpp"

namespace fw::test {
namespace {

// White noise through a lag.
class Gusts {
 public:
  Gusts(unsigned seed, double sigma, double time_s)
      : random_(seed), sigma_(sigma), fade_(std::exp(-1e-3 / time_s)) {}
  double step() {
    value_ = fade_ * value_ + sigma_ * std::sqrt(1.0 - fade_ * fade_) * normal_(random_);
    return value_;
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  double sigma_, fade_, value_ = 0.0;
};

// Leaning against a wind of 3 m/s, it loses its cameras.
struct Blind {
  Blind(unsigned seed, double height_m) : vehicle({.seed = seed}) {
    flight.parameters().set(Parameter::fence_top_m, 20.0f);
    vehicle.run(flight, 3.0);
    EXPECT_EQ(flight.arm(), Reason::none) << text_of(flight.ready_to_arm());
    vehicle.run(flight, 1.0);
    EXPECT_EQ(flight.take_off(static_cast<float>(height_m)), Reason::none);
    vehicle.wind_W_ = {0, 3, 0};
    for (int i = 0; i < static_cast<int>(8.0 + 3.0 * height_m); ++i) {
      flight.on_link();
      vehicle.run(flight, 1.0);
    }
    vehicle.capture_on_ = false;
  }
  double clearance_m() const { return -vehicle.p_W_.z() - VehicleModel::kFoot_m; }
  Flight flight;
  VehicleModel vehicle;
};

// By what it has learned of the wind it leans; on its feet, as it lets go, it would tip over them.
TEST(Touchdown, LeansNoFurtherAsItCarriesLess) {
  PositionController control;
  Reference reference;
  reference.start(Vector3::Zero(), 0.0f);
  const Quaternion level = Quaternion::Identity();
  for (int i = 0; i < 400; ++i) {
    std::ignore =
        control.step({0.0f, 0.5f, 0.0f}, Vector3::Zero(), level, reference, 1.0f, 0.025f, true);
  }
  const auto lean_rad = [&](float lift) {
    return std::acos(tilt_cosine(control.sink(0.35f, 0.35f, level, 0.0f, lift).q_WB));
  };
  EXPECT_GT(lean_rad(1.0f), 0.05f);
  EXPECT_LT(lean_rad(0.4f), 1.05f * lean_rad(1.0f));
}

// Each kick throws what the rotors carry up at 0.28 m/s.
TEST(Touchdown, IsKnownWithinASecondAndAHalfThoughItHopsOnItsFeet) {
  constexpr int kKick_ms = 50;
  for (const int period_ms : {300, 450, 700}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      Blind blind(seed, 1.1);
      int touched_ms = -1, ms = 0;
      for (; ms < 12'000 && blind.flight.state() != FlightState::disarmed; ++ms) {
        if (ms % 1000 == 0) blind.flight.on_link();
        if (touched_ms < 0 && blind.clearance_m() < 0.0) touched_ms = ms;
        const bool kicked = touched_ms >= 0 && (ms - touched_ms) % period_ms < kKick_ms;
        blind.vehicle.push_W_N_.z() = kicked ? -5.0 : 0.0;
        blind.vehicle.step(blind.flight);
      }
      ASSERT_GE(touched_ms, 0);
      EXPECT_LT(ms - touched_ms, 1500) << period_ms << " ms, seed " << seed;
      EXPECT_EQ(blind.flight.last_reason(), Reason::no_position);
    }
  }
}

// Air that rises and sinks moves it by what its rotors gain and lose, 2.4 N for each metre a second of it. Of 1.5 N
// it is held in place, as the ground would.
TEST(Touchdown, IsNotSeenInTheAir) {
  for (const double mean_N : {0.0, -1.5, 2.0}) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
      Blind blind(seed, 3.0);
      Gusts gusts(seed, 2.4 * 0.5, 0.7);
      for (int ms = 0; ms < 20'000 && blind.clearance_m() > 0.3; ++ms) {
        if (ms % 1000 == 0) blind.flight.on_link();
        blind.vehicle.push_W_N_.z() = mean_N + gusts.step();
        blind.vehicle.step(blind.flight);
        ASSERT_NE(static_cast<int>(blind.flight.state()), static_cast<int>(FlightState::disarmed))
            << mean_N << " N, seed " << seed << ", " << blind.clearance_m() << " m, " << ms
            << " ms";
      }
    }
  }
}

}  // namespace
}  // namespace fw::test
