// What the best of filters can know of its height once motion capture is gone: barometer and accelerometer as they
// are here, attitude known without error, wash and wind none. Kalman's covariance, so no filter does better.
//
//   States   height, climb, the accelerometer's turn-on bias and its flicker (four Gauss-Markov terms, as
//            sensors/noise.hpp makes it), the barometer's wander as a height
//   Before   100 s of capture to 1 mm: what it teaches about biases and wander is taken along
//   Said at  test_plans/flight/teleoperation_by_drag.lua, which judges by it
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/near.hpp"
#include "plant/sensors/barometer.hpp"
#include "plant/sensors/imu.hpp"
#include "plant/sensors/noise.hpp"

namespace whirl::plant {
namespace {

constexpr int kFlicker = 4, kStates = 4 + kFlicker, kWander = kStates - 1;
using Matrix = Eigen::Matrix<double, kStates, kStates>;
using Row = Eigen::Matrix<double, 1, kStates>;

constexpr double kPa_per_m = 1.2 * 9.81;
constexpr double kStep_s = 0.025;  // of capture's 40 Hz

class Covariance {
 public:
  Covariance(const BarometerParams& barometer, const TriadParams& accelerometer) {
    P_(0, 0) = P_(1, 1) = 1.0;
    P_(2, 2) = std::pow(accelerometer.turn_on_bias, 2);
    F_(0, 1) = kStep_s;
    for (int i = 2; i < kWander; ++i) F_(1, i) = kStep_s, F_(0, i) = 0.5 * kStep_s * kStep_s;
    const double term =
        accelerometer.bias_instability * std::sqrt(std::log(10.0) / std::numbers::pi);
    for (int i = 0; i < kFlicker; ++i) wanders(3 + i, term, std::pow(10.0, i));
    wanders(kWander, barometer.drift_Pa / kPa_per_m, barometer.drift_time_s);
    const double q = std::pow(accelerometer.noise_density, 2);
    Q_(0, 0) = q * std::pow(kStep_s, 3) / 3.0;
    Q_(0, 1) = Q_(1, 0) = q * kStep_s * kStep_s / 2.0;
    Q_(1, 1) = q * kStep_s;
    pressure_m2_ = std::pow(barometer.noise_density_Pa / kPa_per_m, 2) / kStep_s;
  }
  void run(double duration_s, bool captured) {
    Row height = Row::Zero(), pressure = Row::Zero();
    height(0) = pressure(0) = pressure(kWander) = 1.0;
    for (double t_s = 0.0; t_s < duration_s - 1e-9; t_s += kStep_s) {
      P_ = F_ * P_ * F_.transpose() + Q_;
      correct(pressure, pressure_m2_);
      if (captured) correct(height, 1e-6);
    }
  }
  double height_m() const { return std::sqrt(P_(0, 0)); }

 private:
  void wanders(int i, double deviation, double time_s) {
    P_(i, i) = deviation * deviation;
    F_(i, i) = std::exp(-kStep_s / time_s);
    Q_(i, i) = P_(i, i) * -std::expm1(-2.0 * kStep_s / time_s);
  }
  void correct(const Row& what, double variance) {
    const Eigen::Matrix<double, kStates, 1> column = P_ * what.transpose();
    P_ -= column * column.transpose() / (what * column + variance);
  }

  Matrix P_ = Matrix::Zero(), F_ = Matrix::Identity(), Q_ = Matrix::Zero();
  double pressure_m2_ = 0.0;
};

double best_m(const BarometerParams& barometer, double after_s) {
  Covariance covariance(barometer, mpu6000_physics().accelerometer);
  covariance.run(100.0, true);
  covariance.run(after_s, false);
  return covariance.height_m();
}

// By the barometer alone, its wander known when capture was lost: a Gauss-Markov process, closed form.
double barometer_alone_m(const BarometerParams& barometer, double after_s) {
  return barometer.drift_Pa / kPa_per_m *
         std::sqrt(-std::expm1(-2.0 * after_s / barometer.drift_time_s));
}

TEST(HeightWithoutCapture, TheBestOfFiltersKnowsItTo27CentimetresAfterAMinute) {
  EXPECT_TRUE(near(best_m({}, 60.0), 0.27, printed_to(0.01)));
  EXPECT_TRUE(near(barometer_alone_m({}, 60.0), 0.29, printed_to(0.01)));
}

// A filter may follow the accelerometer for some ten seconds; after a minute it gains 6 %.
TEST(HeightWithoutCapture, TheAccelerometerHelpsAtFirst) {
  for (const double after_s : {5.0, 10.0, 20.0, 40.0, 60.0}) {
    EXPECT_LT(best_m({}, after_s), barometer_alone_m({}, after_s)) << after_s;
  }
  EXPECT_TRUE(near(best_m({}, 10.0) / barometer_alone_m({}, 10.0), 0.56, printed_to(0.1)));
  EXPECT_TRUE(near(best_m({}, 60.0) / barometer_alone_m({}, 60.0), 0.94, printed_to(0.02)));
}

// Its wander drawn a thousand times: what it has done since capture went is what the height is off.
TEST(HeightWithoutCapture, TwoFlightsInFiveStayWithin30CentimetresForAMinuteByTheBarometer) {
  const BarometerParams barometer;
  int within = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    GaussMarkov wander(barometer.drift_Pa, barometer.drift_time_s, seed, "wander");
    const double known_Pa = wander.value();
    double worst_Pa = 0.0;
    for (double t_s = 0.5; t_s <= 60.0; t_s += 0.5) {
      const double expected_Pa = known_Pa * std::exp(-t_s / barometer.drift_time_s);
      worst_Pa = std::max(worst_Pa, std::abs(wander.step(0.5) - expected_Pa));
    }
    within += worst_Pa < 0.3 * kPa_per_m ? 1 : 0;
  }
  EXPECT_TRUE(near(within / 1000.0, 0.4, stated(0.05, "three sigma of a thousand draws")));
}

// Without a barometer the accelerometer alone is worse than with it, and without wander far better than 0.3 m.
TEST(HeightWithoutCapture, ItIsTheBarometersWanderThatBoundsIt) {
  BarometerParams steady;
  steady.drift_Pa = 1e-3;
  EXPECT_LT(best_m(steady, 60.0), 0.02);
  BarometerParams wild;
  wild.drift_Pa = 1e4;
  EXPECT_GT(best_m(wild, 60.0), 1.0);  // 3.92e-3 sqrt(60^3 / 3) m of white noise alone
}

}  // namespace
}  // namespace whirl::plant
