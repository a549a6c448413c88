// The velocity-aided filters and the height filter on motions made here, from Newton and with the
// signs of math.hpp: nothing of what the filters are made of.
#include <gtest/gtest.h>

#include <random>

#include "base/near.hpp"
#include "firmware/control/reference.hpp"
#include "firmware/estimation/body_filter.hpp"
#include "firmware/estimation/height_filter.hpp"
#include "firmware/estimation/inertial_filter.hpp"

namespace fw {
namespace {

using whirl::near, whirl::stated;

constexpr float kG = 9.80665f, kStep_s = 0.005f;
constexpr double kDegree = M_PI / 180.0;

double apart_rad(const Quaternion& a, const Quaternion& b) {
  return a.cast<double>().normalized().angularDistance(b.cast<double>().normalized());
}

// Swings about a level attitude; velocity follows from tilt. In wind, drag is felt of the air.
struct Motion {
  double t_s = 0.0, scale = 1.0;
  Eigen::Vector3d v_W{0, 0, 0}, wind_W{0, 0, 0}, gyro_bias{0, 0, 0};
  Quaternion q_WB = Quaternion::Identity();
  Vector3 w_B = Vector3::Zero(), a_B = Vector3::Zero();
  float yaw_rad = 0.0f;

  void step() {
    const double f = 2.0 * M_PI / 4.0;
    const auto at = [&](double t) {
      return from_euler(static_cast<float>(0.06 * std::sin(f * t)),
                        static_cast<float>(0.05 * std::sin(1.3 * f * t)), yaw_rad);
    };
    const Quaternion next = at(t_s + kStep_s);
    const Quaternion turn = at(t_s).conjugate() * next;
    w_B = 2.0f / kStep_s * turn.vec() + gyro_bias.cast<float>();
    q_WB = next;
    t_s += kStep_s;
    // Thrust holds the height; drag 0.04 s/m of it.
    const Eigen::Matrix3d R = q_WB.toRotationMatrix().cast<double>();
    const double thrust = 9.80665 / R(2, 2);
    const Eigen::Vector3d air_B = R.transpose() * (v_W - wind_W);
    const Eigen::Vector3d force_B(-0.04 * thrust * air_B.x(), -0.04 * thrust * air_B.y(), -thrust);
    Eigen::Vector3d felt = force_B;
    v_W += kStep_s * (R * force_B + Eigen::Vector3d(0, 0, 9.80665));
    felt.z() *= scale;
    a_B = felt.cast<float>();
  }
  Vector3 v_AB_B() const { return q_WB.conjugate() * (v_W - wind_W).cast<float>(); }
};

Vector3 by_drag(const Motion& m, const Vector3& v_known_B) {
  return {m.a_B.x() / (0.04f * m.a_B.z()), m.a_B.y() / (0.04f * m.a_B.z()), v_known_B.z()};
}

struct Start {
  float scale, tilt_deg;
};
class Convergence : public ::testing::TestWithParam<Start> {};
INSTANTIATE_TEST_SUITE_P(WrongByMuch, Convergence,
                         ::testing::Values(Start{0.8f, 30.0f}, Start{1.2f, 30.0f},
                                           Start{0.8f, -30.0f}, Start{1.2f, 0.0f}));

TEST_P(Convergence, OfFilter1AloneIsDoneIn10s) {
  Motion m;
  BodyFilter filter;
  filter.start(from_euler(static_cast<float>(GetParam().tilt_deg * kDegree), 0.0f, 0.0f),
               GetParam().scale);
  for (int i = 0; i < 2000; ++i) {
    m.step();
    filter.step(m.w_B, m.a_B, by_drag(m, m.v_AB_B()), {}, kStep_s);
  }
  EXPECT_TRUE(near(filter.scale(), 1.0, stated(0.05, "what is asked of it")));
  EXPECT_LT(apart_rad(filter.q_WB(), m.q_WB), 1.0 * kDegree);
  EXPECT_LT((filter.v_AB_B_mps() - m.v_AB_B()).norm(), 0.1f);
}

TEST_P(Convergence, OfFilter2AloneIsDoneIn10s) {
  Motion m;
  InertialFilter filter;
  filter.start(from_euler(static_cast<float>(GetParam().tilt_deg * kDegree), 0.0f, 0.0f),
               Vector3::Zero(), GetParam().scale);
  for (int i = 0; i < 2000; ++i) {
    m.step();
    // What filter 1 would say if it were right, of an attitude that leaves this one alone.
    filter.predict(m.w_B, m.a_B, {filter.q_WB(), filter.v_WB_W_mps(), Vector3::Zero()}, kStep_s);
    if (i % 5 == 0) filter.correct(m.v_W.cast<float>(), 0.0f, 0.025f);
  }
  EXPECT_TRUE(near(filter.scale(), 1.0, stated(0.05, "what is asked of it")));
  EXPECT_LT(apart_rad(filter.q_WB(), m.q_WB), 1.0 * kDegree);
  EXPECT_LT((filter.v_WB_W_mps() - m.v_W.cast<float>()).norm(), 0.1f);
}

TEST(BodyFilter, AnAccelerometerThatReadsThreePercentTooMuchShowsInTheScale) {
  Motion m;
  m.scale = 1.03;
  BodyFilter filter;
  for (int i = 0; i < 4000; ++i) {
    m.step();
    filter.step(m.w_B, m.a_B, m.v_AB_B(), {}, kStep_s);
  }
  EXPECT_TRUE(near(filter.scale(), 1.03, stated(0.01, "what is asked of it")));
}

TEST(BodyFilter, LearnsAGyroBias) {
  Motion m;
  m.gyro_bias = {0.01, -0.02, 0.0};
  BodyFilter filter;
  for (int i = 0; i < 200 * 400; ++i) {
    m.step();
    filter.step(m.w_B, m.a_B, m.v_AB_B(), {}, kStep_s);
  }
  EXPECT_TRUE(near(filter.gyro_bias_B_radps().x(), 0.01, stated(0.001, "6 time constants")));
  EXPECT_TRUE(near(filter.gyro_bias_B_radps().y(), -0.02, stated(0.002, "6 time constants")));
  EXPECT_LT(apart_rad(filter.q_WB(), m.q_WB), 1.0 * kDegree);
}

TEST(BodyFilter, TurnsItsHeadingTowardsTheField) {
  Motion m;
  m.yaw_rad = 0.7f;
  const float declination = 0.2f;
  // North of the field lies east of W's north; the field also points down.
  const Vector3 field_W(20.0f * std::cos(declination), 20.0f * std::sin(declination), 50.0f);
  BodyFilter filter;
  filter.start(from_euler(0.0f, 0.0f, -0.4f), 1.0f);
  for (int i = 0; i < 200 * 20; ++i) {
    m.step();
    filter.step(m.w_B, m.a_B, m.v_AB_B(), {}, kStep_s);
    if (i % 3 == 0) {
      filter.correct_heading(m.q_WB.conjugate() * field_W, declination, 3 * kStep_s);
    }
  }
  EXPECT_TRUE(near(yaw_of(filter.q_WB()), 0.7, stated(0.01, "10 time constants")));
}

TEST(CoupledFilters, FindTheWindAndFollowItsChange) {
  Motion m;
  m.wind_W = {3.0, -1.0, 0.0};
  BodyFilter body;
  InertialFilter inertial;
  body.start(Quaternion::Identity(), 1.0f);
  inertial.start(Quaternion::Identity(), Vector3::Zero(), 1.0f);
  const auto run = [&](double seconds) {
    for (int i = 0; i < static_cast<int>(seconds / kStep_s); ++i) {
      m.step();
      const FromInertialFilter to_body{
          true, inertial.q_WB(), inertial.v_WB_W_mps() - inertial.wind_W_mps(), Vector3::Zero()};
      const FromBodyFilter to_inertial{body.q_WB(), body.q_WB() * body.v_AB_B_mps(),
                                       Vector3::Zero()};
      body.step(m.w_B, m.a_B, by_drag(m, m.v_AB_B()), to_body, kStep_s);
      inertial.predict(m.w_B, m.a_B, to_inertial, kStep_s);
      if (i % 40 == 0) inertial.correct(m.v_W.cast<float>(), 0.0f, 0.2f);
    }
  };
  run(20.0);
  EXPECT_LT((inertial.wind_W_mps() - m.wind_W.cast<float>()).head<2>().norm(), 0.3f);
  m.wind_W.y() += 2.0;
  run(10.0);
  EXPECT_LT((inertial.wind_W_mps() - m.wind_W.cast<float>()).head<2>().norm(), 0.3f);
}

// Each filter alone with what the other knows: no fix, no field, no drag of its own, level and at rest. Half a
// minute, or a minute for the bias, is enough for all but a tenth of what it is off.
TEST(CoupledFilters, Filter1IsDrawnToWhatFilter2Knows) {
  const Vector3 bias(0.1f, -0.08f, 0.0f), v(1.5f, -0.8f, 0.0f);
  const Quaternion heading = from_euler(0.0f, 0.0f, 0.5f);
  BodyFilter filter;
  for (int i = 0; i < 200 * 60; ++i) {
    filter.step(Vector3::Zero(), bias - kG * Vector3::UnitZ(), filter.v_AB_B_mps(),
                {true, heading, heading * v, bias}, kStep_s);
  }
  EXPECT_LT(apart_rad(filter.q_WB(), heading), 0.1 * 0.5);
  EXPECT_LT((filter.v_AB_B_mps() - v).norm(), 0.1f * v.norm());
  EXPECT_LT((filter.accel_bias_B_mps2() - bias).norm(), 0.1f * bias.norm());
}

TEST(CoupledFilters, Filter2IsDrawnToWhatFilter1Knows) {
  const Vector3 bias(0.1f, -0.08f, 0.0f), v(1.5f, -0.8f, 0.0f);
  const Quaternion heading = from_euler(0.0f, 0.0f, 0.5f);
  InertialFilter filter;
  for (int i = 0; i < 200 * 60; ++i) {
    filter.predict(Vector3::Zero(), bias - kG * Vector3::UnitZ(), {heading, v, bias, true},
                   kStep_s);
  }
  EXPECT_LT(apart_rad(filter.q_WB(), heading), 0.1 * 0.5);
  EXPECT_LT((filter.v_WB_W_mps() - v).norm(), 0.1f * v.norm());
  EXPECT_LT((filter.accel_bias_B_mps2() - bias).norm(), 0.1f * bias.norm());
}

TEST(InertialFilter, ComparesALateFixWithWhatItHadThen) {
  Motion m;
  InertialFilter prompt, late;
  std::vector<Vector3> told;
  prompt.start(Quaternion::Identity(), Vector3::Zero(), 1.0f);
  late = prompt;
  double prompt_m = 0.0, late_m = 0.0;
  for (int i = 0; i < 4000; ++i) {
    m.step();
    told.push_back(m.v_W.cast<float>());
    for (InertialFilter* f : {&prompt, &late}) {
      f->predict(m.w_B, m.a_B, {f->q_WB(), f->v_WB_W_mps(), Vector3::Zero()}, kStep_s);
    }
    if (i % 40 != 0 || i < 24) continue;
    prompt.correct(told[static_cast<std::size_t>(i - 24)], 0.0f, 0.2f);
    late.correct(told[static_cast<std::size_t>(i - 24)], 0.12f, 0.2f);
    if (i < 2000) continue;
    prompt_m = std::max(prompt_m, apart_rad(prompt.q_WB(), m.q_WB));
    late_m = std::max(late_m, apart_rad(late.q_WB(), m.q_WB));
  }
  EXPECT_LT(late_m, 0.5 * prompt_m);
}

TEST(HeightFilter, FollowsAClimbThroughNoiseAndAnAccelerometersBias) {
  HeightFilter filter;
  filter.zero(101325.0f);
  std::mt19937 random(5);
  std::normal_distribution<double> noise_m(0.0, 0.10);
  double z = 0.0, vz = 0.0, worst_v = 0.0, worst_z = 0.0;
  for (int i = 0; i < 200 * 60; ++i) {
    const double a = 0.3 * std::sin(0.5 * kStep_s * i);
    vz += kStep_s * a;
    z += kStep_s * vz;
    filter.predict(static_cast<float>(a + 0.2), kStep_s);
    if (i % 3 == 0) {
      const double measured = z + noise_m(random);
      filter.correct(static_cast<float>(101325.0 * std::pow(1.0 + measured / 44330.8, 5.25588)),
                     0.015f);
    }
    if (i < 200 * 15) continue;
    worst_v = std::max(worst_v, std::abs(filter.vz_mps() - vz));
    worst_z = std::max(worst_z, std::abs(filter.z_m() - z));
  }
  EXPECT_LT(worst_v, 0.15);
  EXPECT_LT(worst_z, 0.15);
  EXPECT_TRUE(near(filter.bias_mps2(), 0.2, stated(0.05, "the noise's share")));
}

TEST(HeightFilter, DoesNotBelieveNonsenseButASteadyChange) {
  HeightFilter filter;
  filter.zero(101325.0f);
  const auto feed = [&](float pressure_Pa, int samples) {
    for (int i = 0; i < 3 * samples; ++i) {
      filter.predict(0.0f, kStep_s);
      if (i % 3 == 0) filter.correct(pressure_Pa, 0.015f);
    }
  };
  feed(101325.0f, 100);
  for (const float nonsense : {-4e5f, std::nanf(""), 0.0f, 5e4f}) {
    feed(nonsense, 10);
    EXPECT_TRUE(near(filter.z_m(), 0.0, stated(1e-3, "float"))) << nonsense;
    feed(101325.0f, 10);
  }
  feed(std::nanf(""), 1000);
  EXPECT_TRUE(near(filter.z_m(), 0.0, stated(1e-3, "float")));
  EXPECT_FALSE(filter.believes());
  for (int i = 0; i < 600; ++i) feed(i % 2 ? 99000.0f : 104000.0f, 1);  // leaps about
  EXPECT_TRUE(near(filter.z_m(), 0.0, stated(1e-3, "float")));
  EXPECT_FALSE(filter.believes());
}

// No vehicle leaps by 10 m within a sample: that was the part, or a door that shut. From there on it tells height again.
TEST(HeightFilter, ALeapIsAnotherZeroAndNoHeight) {
  HeightFilter filter;
  filter.zero(101325.0f);
  const auto feed = [&](float pressure_Pa, int samples) {
    for (int i = 0; i < 3 * samples; ++i) {
      filter.predict(0.0f, kStep_s);
      if (i % 3 == 0) filter.correct(pressure_Pa, 0.015f);
    }
  };
  feed(101325.0f, 100);
  feed(101205.0f, 30);
  EXPECT_FALSE(filter.believes());
  feed(101205.0f, 270);
  EXPECT_TRUE(filter.believes());
  EXPECT_TRUE(near(filter.z_m(), 0.0, stated(0.01, "what the last second has lent")));
  feed(101193.0f, 1000);  // 1 m up
  EXPECT_TRUE(near(filter.z_m(), -1.0, stated(0.05, "12 Pa a metre")));
}

// After ten seconds without a reading the pressure is right, and what was reckoned meanwhile is not.
TEST(HeightFilter, AfterAGapAHeightThatStaysIsTaken) {
  HeightFilter filter;
  filter.zero(101325.0f);
  filter.correct(101325.0f, 0.015f);
  for (int i = 0; i < 2000; ++i) filter.predict(0.0f, kStep_s);
  filter.correct(101205.0f, 10.0f);
  for (int i = 0; i < 900; ++i) {
    filter.predict(0.0f, kStep_s);
    if (i % 3 == 0) filter.correct(101205.0f, 0.015f);
  }
  EXPECT_TRUE(near(filter.z_m(), -10.0, stated(0.1, "12 Pa a metre")));
}

// One that climbs at 1.5 m/s without an acceleration has been drawn by that; one that was felt has not.
TEST(HeightFilter, TellsAClimbThatNobodyFelt) {
  HeightFilter unfelt, felt;
  unfelt.zero(101325.0f);
  felt.zero(101325.0f);
  double z_m = 0.0, vz_mps = 0.0;
  for (int i = 0; i < 800; ++i) {
    const float a = i >= 100 && i < 200 ? -3.0f : 0.0f;  // half a second to 1.5 m/s
    vz_mps += a * kStep_s;
    z_m += vz_mps * kStep_s;
    unfelt.predict(0.0f, kStep_s);
    felt.predict(a, kStep_s);
    const auto pressure_Pa = static_cast<float>(101325.0 + 12.01 * z_m);
    if (i % 3 == 0) unfelt.correct(pressure_Pa, 0.015f);
    if (i % 3 == 0) felt.correct(pressure_Pa, 0.015f);
  }
  EXPECT_LT(unfelt.drawn_mps(), -0.4f);
  EXPECT_LT(std::abs(felt.drawn_mps()), 0.1f);
}

TEST(Reference, CarriesATrajectoryOnBetweenItsPoints) {
  Reference reference;
  const TrajectoryPoint point{{1, 2, -1}, {0.5f, 0, 0}, {0, 0.2f, 0}, 0.1f};
  reference.follow(point, {0.3f, 0, 0}, 0.1f, 0.025f);
  EXPECT_TRUE(reference.tracking());
  EXPECT_TRUE(near(reference.p_W_m().x(), 1.05 + 0.3 * 0.001 / 6, stated(1e-5, "float")));
  EXPECT_TRUE(near(reference.p_W_m().y(), 2.001, stated(1e-5, "float")));
  EXPECT_TRUE(near(reference.v_W_mps().y(), 0.02, stated(1e-6, "float")));
  EXPECT_TRUE(near(reference.a_W_mps2().x(), 0.03, stated(1e-6, "float")));
  EXPECT_TRUE(near(reference.yaw_rad(), 0.015, stated(1e-5, "0.6 rad/s for a step")));
  reference.step({1, 2, -1}, 0.1f, 0.025f);
  EXPECT_FALSE(reference.tracking());
}

}  // namespace
}  // namespace fw
