// Oracle: a stand made of the ESC's own model with known constants and known noise. What is identified
// must be what was put in; data that say nothing must be refused in one sentence.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "base/near.hpp"
#include "base/random.hpp"
#include "base/scratch_folder.hpp"
#include "harness/calibrate/data_file.hpp"
#include "harness/calibrate/report.hpp"

namespace whirl::calibrate {
namespace {

// An ideal ESC's rotor: CT = c1 (c2 - lambda) = c4 li lambda, CP = c3 + CT (kappa li + ls) c0.
struct Truth {
  double loss_ohm = 0.13, loss_V = 0.22, drag = 0.0098, ke = 0.0103, R = 0.14;
  double overlap = 1e-4;
  double loss_share = 0.0, loss_emf = 0.0;
  double excess_V = 0.0;  // of the bridge, to and fro over the points: timing that is not perfect
  double J = 3.7e-5, gain = 0.94, offset = 0.0;
  double c0 = 0.11, c1 = 9e-5, c2 = 0.22, c3 = 2e-8, d0 = 3.0, d1 = -1.1e5;
  double radius_m = 0.127, density = 1.225;
  double speed_effect = 0.0, middle_radps = 459.0;
  double c4 = 2.0 * 1.225 * std::numbers::pi * std::pow(0.127, 4);

  double li(double ls) const {  // the quadratic of thrust_model.hpp, solved by bisection
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 60; ++i) {
      const double x = 0.5 * (low + high);
      (c4 * x * (x + ls) < c1 * (c2 - x - ls) ? low : high) = x;
    }
    return low;
  }
  double CT(double ls) const { return c1 * (c2 - li(ls) - ls); }
  double CP(double ls) const { return c3 + CT(ls) * ((d0 + d1 * CT(ls)) * li(ls) + ls) * c0; }
};

class Stand {
 public:
  Stand(const Truth& truth, std::uint64_t seed, double noise)
      : t_(truth), random_(seed, "identify_test"), noise_(noise) {}

  StandData all() {
    StandData d;
    d.radius_m = t_.radius_m;
    d.rest = {rest(), rest()};
    for (double w = 200.0; w < 620.0; w += 45.0) d.still.push_back(turning(w, 0.0));
    for (const double wind : {1.5, 2.3, 3.3, 4.2}) {
      for (double w = 370.0; w < 560.0; w += 45.0) d.blown.push_back(turning(w, wind));
    }
    d.zero = zero();
    d.updraft = {turning(450.0, -3.0, t_.CT(0.0), 0.98 * t_.CP(0.0))};
    d.steps = transient([](double t) { return t - std::floor(t) < 0.5 ? 45.0 : -45.0; }, 0.08);
    d.sinusoid =
        transient([](double t) { return 45.0 * std::sin(4.0 * std::numbers::pi * t); }, 0.0);
    return d;
  }

 private:
  double noisy(double x) { return x * (1.0 + noise_ * random_.normal()); }
  // What the motor's voltage and the power balance agree on.
  double amps(double torque, double w, double excess_V) const {
    const double kept = 1.0 - t_.loss_share;
    const double a = kept * (t_.R + t_.overlap * w) - t_.loss_ohm;
    const double b = kept * (t_.ke * w + excess_V) - t_.loss_V - t_.loss_emf * w;
    const double c = (torque + t_.drag) * w;
    return (-b + std::sqrt(b * b + 4.0 * a * c)) / (2.0 * a);
  }
  SteadyPoint with_currents(SteadyPoint x, double torque) {
    const double w = x.speed_radps, excess_V = t_.excess_V * std::sin(1e3 * (w + torque));
    const double current_A = amps(torque, w, excess_V);
    x.esc_V = x.meter_V = 16.4;
    x.duty = (t_.ke * w + (t_.R + t_.overlap * w) * current_A + excess_V) / x.esc_V;
    x.meter_A = current_A * x.duty;
    x.esc_A = noisy(x.meter_A / t_.gain);
    return x;
  }
  SteadyPoint rest() {
    SteadyPoint x;
    x.esc_A = t_.offset + noise_ * random_.normal();
    x.esc_V = x.meter_V = 16.4;
    return x;
  }
  SteadyPoint turning(double w, double wind, double CT, double CP) {
    SteadyPoint x;
    x.wind_mps = wind;
    x.speed_radps = w;
    x.thrust_N = noisy(CT * w * w);
    const double torque = CP * w * w;
    x.torque_Nm = noisy(torque);
    return with_currents(x, torque);
  }
  SteadyPoint turning(double w, double wind) {
    const double ls = wind / (w * t_.radius_m);
    const double effect = 1.0 + t_.speed_effect * (w / t_.middle_radps - 1.0);
    return turning(w, wind, t_.CT(ls), t_.CP(0.0) + (t_.CP(ls) - t_.CP(0.0)) / effect);
  }
  std::vector<SteadyPoint> zero() {  // a line of CP through c3 where CT is zero
    std::vector<SteadyPoint> points;
    for (const double CT : {2e-6, 1e-6, -0.5e-6, -1e-6}) {
      points.push_back(turning(400.0, 10.0, CT, t_.c3 + 0.005 * CT));
    }
    return points;
  }
  // Speed swings about 450 rad/s by this law, integrated for the current that it takes.
  template <typename Law>
  std::vector<Sample> transient(Law law, double lag_s) {
    std::vector<Sample> samples;
    constexpr double kStep_s = 2e-3;
    double w = 450.0 + law(0.0), filtered = w;
    for (int i = 0; i < 2500; ++i) {
      const double t = kStep_s * i;
      const double wanted = 450.0 + law(t);
      filtered = lag_s > 0.0 ? filtered + kStep_s / lag_s * (wanted - filtered) : wanted;
      const double rate =
          lag_s > 0.0 ? (wanted - filtered) / lag_s : (450.0 + law(t + 1e-5) - wanted) / 1e-5;
      w = filtered;
      SteadyPoint x;
      x.speed_radps = w;
      x = with_currents(x, t_.CP(0.0) * w * w + t_.J * rate);
      samples.push_back({t, x.duty, noise_ > 0.0 ? noisy(w) : w, x.esc_A, x.esc_V});
    }
    return samples;
  }

  Truth t_;
  RandomStream random_;
  double noise_;
};

TEST(Identify, FindsWhatWasPutIn) {
  const Truth t;
  const auto found = identify(Stand(t, 1, 0.0).all());
  ASSERT_TRUE(found.ok()) << found.error().message();
  const Calibration& c = found.value();
  EXPECT_TRUE(physical(c).ok()) << physical(c).error().message();
  const auto close = [](double x, double truth, double share) {
    EXPECT_TRUE(near(x, truth, stated(share * std::abs(truth), "a share of it")));
  };
  close(c.sense.gain.value, t.gain, 1e-6);
  EXPECT_TRUE(near(c.sense.offset.value, t.offset, stated(1e-9, "no noise: round-off")));
  EXPECT_TRUE(near(c.still.updraft_share, 0.98, stated(1e-3, "no noise: the firmware's floats")));
  close(c.motor.loss_ohm.value, t.loss_ohm, 1e-6);
  close(c.motor.loss_V.value, t.loss_V, 1e-6);
  close(c.motor.drag.value, t.drag, 1e-6);
  close(c.motor.back_emf.value, t.ke, 1e-6);
  close(c.motor.resistance.value, t.R, 1e-6);
  close(c.motor.overlap.value, t.overlap, 1e-6);
  close(c.motor.inertia.value, t.J, 5e-3);  // trapezoids over a step's corners
  close(c.still.a[0].value, t.CT(0.0), 1e-5);
  close(c.still.q[0].value, t.CP(0.0), 1e-5);
  close(c.rotor.c0.value, t.c0, 1e-3);
  close(c.rotor.c1.value, t.c1, 1e-3);
  close(c.rotor.c2.value, t.c2, 1e-3);
  close(c.rotor.c3.value, t.c3, 1e-3);
  close(c.rotor.d0.value, t.d0, 1e-3);
  close(c.rotor.d1.value, t.d1, 1e-3);
}

TEST(Identify, WeighsVoltageAndBackEmfWhereTheyDisagree) {
  Truth t;
  t.loss_share = 0.3, t.loss_emf = -0.0032, t.loss_V = 0.5, t.loss_ohm = 0.08, t.drag = 0.0118;
  t.excess_V = 0.05;
  const auto found = identify(Stand(t, 1, 0.0).all());
  ASSERT_TRUE(found.ok()) << found.error().message();
  const MotorFit& motor = found.value().motor;
  EXPECT_TRUE(near(motor.loss_share.value, t.loss_share, stated(1e-6, "no noise: round-off")));
  EXPECT_TRUE(near(motor.loss_emf.value, t.loss_emf, stated(1e-8, "no noise: round-off")));
  EXPECT_TRUE(near(motor.loss_ohm.value, t.loss_ohm, stated(1e-6, "no noise: round-off")));
  EXPECT_TRUE(near(motor.drag.value, t.drag, stated(1e-6, "no noise: round-off")));
  EXPECT_TRUE(near(found.value().rotor.c0.value, t.c0,
                   stated(1e-3 * t.c0, "0.1 %: the firmware's floats, the solver's tolerance")));
}

// Where they agree there is nothing to weigh: the losses are found alone.
TEST(Identify, AnIdealMotorHasOneWitnessOfItsPower) {
  const auto found = identify(Stand(Truth{}, 1, 1e-4).all());
  ASSERT_TRUE(found.ok()) << found.error().message();
  EXPECT_EQ(found.value().motor.loss_share.value, 0.0);
  EXPECT_EQ(found.value().motor.loss_emf.value, 0.0);
}

// On a blade whose loss of power at one inflow ratio grows with speed.
TEST(Identify, FindsTheSpeedsEffect) {
  Truth t;
  t.speed_effect = 0.5;
  const auto found = identify(Stand(t, 1, 0.0).all());
  ASSERT_TRUE(found.ok()) << found.error().message();
  EXPECT_TRUE(near(found.value().rotor.speed_effect.value, 0.5,
                   stated(0.01, "1 %: the firmware's floats, the solver's tolerance")));
  EXPECT_TRUE(near(found.value().rotor.c0.value, t.c0,
                   stated(0.01 * t.c0, "1 %: the firmware's floats, the solver's tolerance")));
}

// Apparent constants let a tenth more through the winding: their limit is told as much lower, and never alone.
TEST(Identify, TellsTheLimitInTheAmperesOfTheMotorThatItTells) {
  auto found = identify(Stand(Truth{}, 1, 1e-4).all());
  ASSERT_TRUE(found.ok()) << found.error().message();
  const auto told = [&found](const std::string& start) {
    std::string line;
    for (const std::string& one : lines(found.value())) {
      if (one.rfind(start, 0) == 0) line = one;
    }
    return line;
  };
  EXPECT_EQ(told("set resistance"), "");
  EXPECT_EQ(told("set max_current"), "");
  calibrate::Setup setup;
  setup.tell_motor = true;
  found = identify(Stand(Truth{}, 1, 1e-4).all(), setup);
  ASSERT_TRUE(found.ok()) << found.error().message();
  EXPECT_NE(told("set resistance"), "");
  EXPECT_EQ(told("set max_current"), "set max_current 18.18182");
}

// An updraft takes 2 % less than still air; air that is 3 % thinner takes 3 % less of that.
TEST(Identify, TellsTheSharedPowerOfOtherAirToo) {
  const auto told = [](double air_within) {
    calibrate::Setup setup;
    setup.air_within = air_within;
    const auto found = identify(Stand(Truth{}, 1, 1e-4).all(), setup);
    EXPECT_TRUE(found.ok()) << found.error().message();
    for (const std::string& one : lines(found.value())) {
      if (one.rfind("set shared", 0) == 0) return std::stod(one.substr(11));
    }
    return 0.0;
  };
  EXPECT_TRUE(near(told(0.0), 0.98, stated(1e-3, "noise")));
  EXPECT_TRUE(near(told(0.03), 0.98 * 0.97, stated(1e-3, "noise")));
}

TEST(Identify, IntervalsCoverTheTruthInNinetyFivePercentOfSeeds) {
  constexpr int kSeeds = 300;
  const Truth t;
  int ohm = 0, drag = 0, a2 = 0, a1 = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const StandData data = Stand(t, static_cast<std::uint64_t>(seed), 1e-3).all();
    const auto sense = fit_sense(data);
    ASSERT_TRUE(sense.ok());
    const auto motor = fit_motor(data, sense.value());
    ASSERT_TRUE(motor.ok()) << motor.error().message();
    const auto still = fit_still_air(data, motor.value());
    ASSERT_TRUE(still.ok());
    const auto covers = [](const Coefficient& c, double truth) {
      return std::abs(c.value - truth) <= c.half_width ? 1 : 0;
    };
    ohm += covers(motor.value().loss_ohm, t.loss_ohm);
    drag += covers(motor.value().drag, t.drag);
    a2 += covers(still.value().a[0], t.CT(0.0));
    a1 += covers(still.value().a[1], 0.0);
  }
  // The noise is a share of the reading, not the constant that least squares suppose: the count may
  // differ from 285 by more than its own four standard deviations of 15.
  for (const int count : {ohm, drag, a2, a1})
    EXPECT_TRUE(near(count, 285, stated(20, "five standard deviations and a third")));
}

TEST(Identify, OneSpeedIsRefusedInOneSentence) {
  StandData data = Stand(Truth{}, 1, 1e-4).all();
  for (SteadyPoint& x : data.still) x = data.still.front();
  const auto found = identify(data);
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(found.error().kind, ErrorKind::bad_input);
}

TEST(Identify, NoWindIsRefusedByName) {
  StandData data = Stand(Truth{}, 1, 0.0).all();
  data.blown = data.still;
  const auto found = identify(data);
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().message().find("c0"), std::string::npos) << found.error().message();
}

TEST(Identify, NoPointAboutZeroThrustIsRefused) {
  StandData data = Stand(Truth{}, 1, 0.0).all();
  for (SteadyPoint& x : data.zero) x.thrust_N = std::abs(x.thrust_N);
  const auto found = identify(data);
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().message().find("zero thrust"), std::string::npos);
}

TEST(Identify, AStoppedMotorIsRefused) {
  StandData data = Stand(Truth{}, 1, 0.0).all();
  data.blown[3].duty = 0.0;
  EXPECT_FALSE(identify(data).ok());
}

TEST(Identify, PowerBelowIdealIsRefused) {  // as the thesis's own torque figures are
  Truth t;
  t.d0 = 0.8, t.d1 = 0.0;
  const auto found = identify(Stand(t, 1, 0.0).all());
  ASSERT_TRUE(found.ok()) << found.error().message();
  const auto good = physical(found.value());
  ASSERT_FALSE(good.ok());
  EXPECT_NE(good.error().message().find("kappa"), std::string::npos) << good.error().message();
}

TEST(Identify, DataReadBackFromTheirFileGiveTheSameLines) {
  const StandData data = Stand(Truth{}, 1, 1e-5).all();
  const ScratchFolder folder;
  const std::string path = folder.file("data.txt");
  std::ofstream(path) << data_text(data);
  const auto back = read_data(path);
  ASSERT_TRUE(back.ok()) << back.error().message();
  const auto one = identify(data), two = identify(back.value());
  ASSERT_TRUE(one.ok() && two.ok());
  EXPECT_EQ(lines(one.value()), lines(two.value()));
  std::ofstream(path) << "still 1 2 3\n";
  ASSERT_FALSE(read_data(path).ok());
  EXPECT_NE(read_data(path).error().place.find(":1"), std::string::npos);
}

TEST(Identify, ThrustIsFoundBackFromPower) {
  const auto found = identify(Stand(Truth{}, 1, 0.0).all());
  ASSERT_TRUE(found.ok());
  int told = 0;
  for (const double error : found_back(found.value().rotor)) {
    if (std::isnan(error)) continue;
    ++told;
    EXPECT_LT(std::abs(error), 2e-3);
  }
  EXPECT_GT(told, 10);
}

}  // namespace
}  // namespace whirl::calibrate
