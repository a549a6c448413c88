// The drag coefficient out of motions made here: specific forces by the law of drag, noise and wind of this
// file's own.
#include <gtest/gtest.h>

#include <random>

#include "base/near.hpp"
#include "firmware/estimation/drag_identification.hpp"
#include "firmware/estimation/drag_model.hpp"

namespace fw {
namespace {

using whirl::near, whirl::stated;

constexpr double kG = 9.80665, kStep_s = 0.005;

// Flies to and fro along a heading, with as much tilt as that takes.
struct Shuttle {
  double drag_spm = 0.04, frame_s2pm2 = 0.0009;
  double speed_mps = 0.6, period_s = 6.0, heading_rad = 0.5;
  Eigen::Vector3d wind_W{0, 0, 0}, accel_zero_B{0, 0, 0};
  double noise_mps2 = 0.1;
  double t_s = 0.0;
  std::mt19937 random{7};

  void fly(DragIdentification& drag, double seconds) {
    std::normal_distribution<double> noise(0.0, noise_mps2);
    for (const double end_s = t_s + seconds; t_s < end_s; t_s += kStep_s) {
      const double w = 2.0 * M_PI / period_s;
      const Eigen::Vector3d way(std::cos(heading_rad), std::sin(heading_rad), 0.0);
      const Eigen::Vector3d v_W = speed_mps * std::sin(w * t_s) * way;
      const double a = speed_mps * w * std::cos(w * t_s);
      const Eigen::Quaterniond q_WB =
          Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()) *
          Eigen::Quaterniond(Eigen::AngleAxisd(-std::atan(a / kG), Eigen::Vector3d::UnitY()));
      const double thrust = std::hypot(kG, a);
      const Eigen::Vector3d air_B = q_WB.conjugate() * (v_W - wind_W);
      const double drag_ps = (drag_spm + frame_s2pm2 * air_B.norm()) * thrust;
      const Eigen::Vector3d felt =
          Eigen::Vector3d(-drag_ps * air_B.x(), -drag_ps * air_B.y(), -thrust) + accel_zero_B +
          Eigen::Vector3d(noise(random), noise(random), noise(random));
      drag.add(felt.cast<float>(), q_WB.cast<float>(), v_W.cast<float>());
    }
  }
};

DragIdentification begun() {
  DragIdentification drag;
  drag.start(0.04f);
  return drag;
}

class Coefficient : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(FromLittleToMuch, Coefficient, ::testing::Values(0.028, 0.04, 0.052));

TEST_P(Coefficient, IsFoundInHalfAMinuteOfShuttlingWhateverTheWindAndTheZeroPoint) {
  Shuttle flight{.drag_spm = GetParam()};
  flight.wind_W = {2.0, -1.0, 0.0};
  flight.accel_zero_B = {0.1, -0.15, 0.1};
  DragIdentification drag = begun();
  flight.fly(drag, 30.0);
  EXPECT_TRUE(drag.identified());
  EXPECT_TRUE(near(drag.drag_spm(), GetParam(), stated(0.05 * GetParam(), "what is asked of it")));
  EXPECT_TRUE(near(drag.drag_spm(), GetParam(),
                   stated(3.0 * drag.sigma_spm() + 0.01 * GetParam(),
                          "3 sigma, and 1 % of thrust by the zero")));
}

TEST(DragModel, GivesTheVelocityBackWhoseDragItIsGiven) {
  for (const double speed_mps : {0.0, 0.3, 3.0, 8.0}) {
    const Eigen::Vector2d v = speed_mps * Eigen::Vector2d(0.8, -0.6);
    const Eigen::Vector2d y = (0.035 + config::kFrameDrag_s2pm2 * speed_mps) * v;
    const Eigen::Vector2f back = velocity_through_air(y.cast<float>(), 0.035f);
    EXPECT_TRUE(near((back.cast<double>() - v).norm(), 0.0, stated(1e-5, "float")));
  }
}

TEST(DragIdentification, LearnsNothingWhereTheVelocityStays) {
  Shuttle hover{.drag_spm = 0.052, .speed_mps = 0.1};
  hover.wind_W = {3.0, 0.0, 0.0};
  DragIdentification drag = begun();
  const float sigma_before = drag.sigma_spm();
  hover.fly(drag, 60.0);
  EXPECT_EQ(drag.drag_spm(), 0.04f);
  EXPECT_EQ(drag.sigma_spm(), sigma_before);
  EXPECT_FALSE(drag.identified());
}

TEST(DragIdentification, AStepOfTheWindIsNoDrag) {
  Shuttle flight{.drag_spm = 0.034};
  DragIdentification drag = begun();
  for (const double wind : {0.0, 2.0, -1.0, 3.0}) {
    flight.wind_W = {wind, 0.5 * wind, 0.0};
    flight.fly(drag, 10.0);
  }
  EXPECT_TRUE(near(drag.drag_spm(), 0.034, stated(0.05 * 0.034, "what is asked of it")));
}

TEST(DragIdentification, APauseForgetsTheWindAndKeepsTheCoefficient) {
  Shuttle flight{.drag_spm = 0.05};
  DragIdentification drag = begun();
  flight.fly(drag, 30.0);
  const float found = drag.drag_spm();
  drag.pause();
  EXPECT_EQ(drag.drag_spm(), found);
  flight.wind_W = {-3.0, 2.0, 0.0};
  flight.fly(drag, 10.0);
  EXPECT_TRUE(near(drag.drag_spm(), 0.05, stated(0.05 * 0.05, "what is asked of it")));
}

TEST(DragIdentification, SurvivesWhatIsNoNumber) {
  Shuttle flight{.drag_spm = 0.05};
  DragIdentification drag = begun();
  flight.fly(drag, 30.0);
  const float found = drag.drag_spm();
  const Vector3 nan = Vector3::Constant(std::numeric_limits<float>::quiet_NaN());
  for (int i = 0; i < 20; ++i) drag.add(nan, Quaternion::Identity(), Vector3::Zero());
  EXPECT_EQ(drag.drag_spm(), found);
  flight.fly(drag, 10.0);
  EXPECT_TRUE(near(drag.drag_spm(), 0.05, stated(0.05 * 0.05, "what is asked of it")));
}

}  // namespace
}  // namespace fw
