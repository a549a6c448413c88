// The calibrations' algorithms against sensors that are made here: errors, noise and attitudes of this file's own.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "base/near.hpp"
#include "firmware/calibration/accelerometer_calibration.hpp"
#include "firmware/calibration/magnetometer_calibration.hpp"
#include "firmware/calibration/motor_field_calibration.hpp"

namespace fw {
namespace {

using whirl::near, whirl::stated;
using Vec = Eigen::Vector3d;
using Mat = Eigen::Matrix3d;

constexpr double kG = 9.80665;

class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}
  double operator()(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); }
  Vec vector(double sigma) {
    const double x = (*this)(sigma), y = (*this)(sigma), z = (*this)(sigma);
    return {x, y, z};
  }

 private:
  std::mt19937 random_;
};

// ---- Least squares

TEST(LeastSquares, FindsALineAndWhatItLeaves) {
  LeastSquares sums;
  sums.start(2);
  // y = 3 + 2 x at -1, 0, 1, with 0.5 added at 0: mean 3 1/6, slope 2, residuals -1/6, 1/3, -1/6.
  for (const float x : {-1.0f, 0.0f, 1.0f}) {
    const float y = 3.0f + 2.0f * x + (x == 0.0f ? 0.5f : 0.0f);
    sums.add(std::array{1.0f, x}, {&y, 1});
  }
  LeastSquares::Solution p{};
  ASSERT_TRUE(sums.solve(0, p));
  EXPECT_TRUE(near(p[0], 3.0 + 1.0 / 6.0, stated(1e-6, "float")));
  EXPECT_TRUE(near(p[1], 2.0, stated(1e-6, "float")));
  EXPECT_TRUE(near(sums.left_over(0, p), 1.0 / 6.0, stated(1e-5, "float, of a sum of 38")));
}

TEST(LeastSquares, RefusesUnknownsThatNoSampleTellsApart) {
  LeastSquares sums;
  sums.start(2);
  for (const float x : {1.0f, 2.0f, 3.0f}) sums.add(std::array{x, 2.0f * x}, {&x, 1});
  LeastSquares::Solution p{};
  EXPECT_FALSE(sums.solve(0, p));
  LeastSquares nothing;
  nothing.start(2);
  EXPECT_FALSE(nothing.solve(0, p));
}

// ---- Accelerometer

struct Accelerometer {
  Vec offset{0.4, -0.35, 0.7}, gain{1.02, 0.98, 1.025};
  double noise_mps2 = 0.07, sway_radps = 0.03;
  Noise noise{11};

  // Held with `up_B` upwards; the side that was completed.
  AccelerometerCalibration::Side hold(AccelerometerCalibration& c, const Vec& up_B,
                                      double seconds) {
    auto side = AccelerometerCalibration::Side::none;
    for (int i = 0; i < std::lround(1000 * seconds); ++i) {
      const Vec a = gain.cwiseProduct(kG * up_B.normalized()) + offset + noise.vector(noise_mps2);
      const Vec w = Vec(0.3, -0.2, 0.1) + sway_radps * Vec::UnitX() * std::sin(0.005 * i);
      const auto now = c.add(a.cast<float>(), w.cast<float>());
      if (now != AccelerometerCalibration::Side::none) side = now;
    }
    return side;
  }
};

const std::vector<Vec> kSides = {{0, 0, -1},     {0.1, 1, -0.15}, {0.2, -1, 0.1},
                                 {1, 0.1, -0.2}, {-1, 0.15, 0.1}, {-0.1, 0.2, 1}};

// A mean over 1.2 s has 0.07 / sqrt(1200) = 0.002 m/s^2; five times that.
TEST(AccelerometerCalibration, FindsOffsetAndScaleFromSixSidesThatPointNowhereExactly) {
  Accelerometer part;
  AccelerometerCalibration c;
  for (const Vec& up : kSides) {
    EXPECT_NE(part.hold(c, up, 1.5), AccelerometerCalibration::Side::none);
  }
  ASSERT_EQ(c.sides_done(), 6u);
  Vector3 offset, scale;
  ASSERT_TRUE(c.solve(offset, scale));
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(near(offset[i], part.offset[i], stated(0.01, "noise of a mean"))) << i;
    EXPECT_TRUE(near(scale[i], 1.0 / part.gain[i], stated(0.001, "noise of a mean over g"))) << i;
  }
}

TEST(AccelerometerCalibration, KnowsEachSideByWhatPointsUpAndCountsItOnce) {
  using Side = AccelerometerCalibration::Side;
  Accelerometer part;
  AccelerometerCalibration c;
  EXPECT_EQ(part.hold(c, {0, 0, -1}, 1.3), Side::top);  // z points down
  EXPECT_EQ(part.hold(c, {0, 0, -1}, 3.0), Side::none);
  EXPECT_EQ(part.hold(c, {1, 0, 0}, 1.5), Side::nose);
  EXPECT_EQ(part.hold(c, {0, 1, 0}, 1.5), Side::right_side);
  EXPECT_EQ(part.hold(c, {0, 1, 1}, 3.0), Side::none);  // on its edge
  EXPECT_EQ(c.sides_done(), 3u);
}

TEST(AccelerometerCalibration, AHandThatTurnsItIsNotStill) {
  Accelerometer part;
  part.sway_radps = 0.4;
  AccelerometerCalibration c;
  EXPECT_EQ(part.hold(c, {0, 0, -1}, 5.0), AccelerometerCalibration::Side::none);
}

TEST(AccelerometerCalibration, RefusesWhatTheDataSheetDoesNotAllow) {
  const struct {
    Vec offset, gain;
    bool good;
  } kParts[] = {{{0.8, 0, 0}, {1, 1, 1}, true},   {{0.9, 0, 0}, {1, 1, 1}, false},
                {{0, 0, 1.3}, {1, 1, 1}, true},   {{0, 0, 1.45}, {1, 1, 1}, false},
                {{0, 0, 0}, {1, 1, 1.045}, true}, {{0, 0, 0}, {1, 0.94, 1}, false}};
  for (const auto& part : kParts) {
    Accelerometer sensor{.offset = part.offset, .gain = part.gain};
    AccelerometerCalibration c;
    for (const Vec& up : kSides) sensor.hold(c, up, 1.5);
    ASSERT_EQ(c.sides_done(), 6u);
    Vector3 offset, scale;
    EXPECT_EQ(c.solve(offset, scale), part.good) << part.offset.transpose();
  }
}

// ---- Magnetometer

struct Compass {
  Vec centre{50, -40, 30};
  Mat bend = Mat::Identity();
  double field_uT = 58.0, noise_uT = 0.2;
  double comes_and_goes_uT = 0.0;  // something else's field, along x, while it is turned
  Noise noise{5};

  Vec read(const Vec& direction) {
    Vec m = bend * (field_uT * direction.normalized()) + centre + noise.vector(noise_uT);
    for (double& x : m) x = 100.0 / 1090.0 * std::round(x * 10.9);  // counts
    return m;
  }
  // A spiral from one pole to the cosine of where it ends, and back.
  void spiral(MagnetometerCalibration& c, double end_cosine) {
    for (int i = 0; i < 8000; ++i) {
      const double share = 1.0 - std::abs(i / 4000.0 - 1.0);
      const double z = 1.0 - (1.0 - end_cosine) * share, turn = 0.15 * i;
      const double r = std::sqrt(1.0 - z * z);
      const Vec other = i / 250 % 2 * comes_and_goes_uT * Vec::UnitX();
      c.add((read({r * std::cos(turn), r * std::sin(turn), z}) + other).cast<float>());
    }
  }
};

Mat soft_iron() {
  Mat bend;
  bend << 1.06, 0.03, -0.02, 0.03, 0.96, 0.04, -0.02, 0.04, 0.99;
  return bend;
}

// Some 600 samples of 0.2 uT leave the centre 0.02 uT uncertain; seven times that.
TEST(MagnetometerCalibration, FindsHardAndSoftIron) {
  for (const Mat& bend : {Mat(Mat::Identity()), soft_iron()}) {
    Compass compass;
    compass.bend = bend;
    MagnetometerCalibration c;
    c.start();
    compass.spiral(c, -1.0);
    ASSERT_TRUE(c.seen_enough()) << c.cells_seen();
    Vector3 centre;
    Matrix3 W;
    ASSERT_TRUE(c.solve(centre, W));
    EXPECT_TRUE(near((centre.cast<double>() - compass.centre).norm(), 0.0, stated(0.15, "noise")));
    // Corrected, any direction reads along itself, of one length.
    const Mat left = W.cast<double>() * bend;
    const Mat even = left / (left.trace() / 3.0);
    EXPECT_TRUE(near((even - Mat::Identity()).cwiseAbs().maxCoeff(), 0.0, stated(2e-3, "noise")));
    EXPECT_TRUE(near(W.trace(), 3.0, stated(1e-4, "float")));
  }
}

TEST(MagnetometerCalibration, HalfASphereIsNotEnough) {
  Compass compass;
  MagnetometerCalibration c;
  c.start();
  compass.spiral(c, 0.0);
  EXPECT_FALSE(c.seen_enough());
  EXPECT_GT(c.cells_seen(), 15u);  // but it has been looked at
}

TEST(MagnetometerCalibration, StandingStillIsNotSeeing) {
  Compass compass;
  MagnetometerCalibration c;
  c.start();
  for (int i = 0; i < 5000; ++i) c.add(compass.read({0.4, 0.0, 0.9}).cast<float>());
  EXPECT_EQ(c.cells_seen(), 0u);
  compass.spiral(c, 0.0);
  const unsigned before = c.cells_seen();
  for (int i = 0; i < 5000; ++i) c.add(compass.read({0.0, 0.0, -1.0}).cast<float>());
  EXPECT_EQ(c.cells_seen(), before);
}

// Also one that was not the same all the time: 10 uT that come and go leave 3 uT RMS.
TEST(MagnetometerCalibration, RefusesAFieldThatIsNotTheEarths) {
  const struct {
    double field_uT, comes_and_goes_uT, stretch;
  } kBad[] = {{58, 10.0, 1.0}, {90, 0.0, 1.0}, {17, 0.0, 1.0}, {40, 0.0, 1.9}};
  for (const auto& bad : kBad) {
    Compass compass{.field_uT = bad.field_uT, .comes_and_goes_uT = bad.comes_and_goes_uT};
    compass.bend(0, 0) = bad.stretch;
    MagnetometerCalibration c;
    c.start();
    compass.spiral(c, -1.0);
    Vector3 centre;
    Matrix3 W;
    EXPECT_FALSE(c.seen_enough() && c.solve(centre, W)) << bad.field_uT << ' ' << bad.stretch;
  }
}

// ---- Motors' currents

struct Bench {
  std::array<Vec, 4> k_uTpA{Vec(0.4, 0.1, 0.2), Vec(0.3, 0.8, 0.4), Vec(-0.2, 0.3, 0.3),
                            Vec(0.5, -0.1, 0.1)};
  double drift_uTps = 0.0, creep_radps = 0.0;  // of the vehicle, nose right, while a motor pulls
  bool motors_turn = true;
  Noise noise{3};

  void run(MotorFieldCalibration& c) {
    c.start();
    double yaw = 0.0;
    for (int i = 0; i < 100'000 && !c.done(); ++i) {
      std::array<double, 4> current_A{};
      for (int m = 0; m < 4; ++m) {
        current_A[static_cast<std::size_t>(m)] = motors_turn && c.motor() == m ? 1.2 : 0.15;
      }
      const double rate = c.motor() >= 0 ? creep_radps : 0.0;
      yaw += 0.01 * rate;
      c.step({0.0f, 0.0f, static_cast<float>(rate + 1e-4)}, 0.01f);
      Vec field(20 * std::cos(yaw) - 5 * std::sin(yaw), -20 * std::sin(yaw) - 5 * std::cos(yaw),
                -50);
      MotorCurrents told{};
      for (std::size_t m = 0; m < 4; ++m) {
        field += current_A[m] * k_uTpA[m];
        told[m] = static_cast<float>(current_A[m] + noise(0.01));
      }
      field += noise.vector(0.2) + 0.01 * i * drift_uTps * Vec::UnitX();
      c.add(field.cast<float>(), told);
    }
  }
};

// 200 samples of 0.2 uT over 1.05 A: 0.014 uT/A, with what the idle adds; four times that. Also where the
// vehicle creeps round by 7 degrees meanwhile.
TEST(MotorFieldCalibration, TellsTheMotorsApart) {
  for (const double creep_radps : {0.0, 0.01}) {
    Bench bench{.creep_radps = creep_radps};
    MotorFieldCalibration c;
    bench.run(c);
    std::array<Vector3, 4> k;
    ASSERT_TRUE(c.solve(k));
    for (std::size_t m = 0; m < 4; ++m) {
      EXPECT_TRUE(near((k[m].cast<double>() - bench.k_uTpA[m]).cwiseAbs().maxCoeff(), 0.0,
                       stated(0.06, "noise")))
          << m << ' ' << creep_radps;
    }
  }
}

TEST(MotorFieldCalibration, RefusesAFieldThatMovesByItselfAndCurrentsThatDoNot) {
  Bench moved{.drift_uTps = 0.5};
  Bench dead{.motors_turn = false};
  for (Bench* bench : {&moved, &dead}) {
    MotorFieldCalibration c;
    bench->run(c);
    std::array<Vector3, 4> k;
    EXPECT_FALSE(c.solve(k));
  }
}

}  // namespace
}  // namespace fw
