// Calibrations in the flight logic and over the radio: when they begin, what ends them, what they leave.
#include "firmware/calibration/calibrator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/near.hpp"
#include "firmware/link/calibration_request.hpp"
#include "firmware/link/telemetry.hpp"
#include "firmware/tests/vehicle_model.hpp"

namespace fw {
namespace {

using whirl::near, whirl::round_off, whirl::stated;

struct Ground {
  Flight flight;
  test::VehicleModel vehicle{{}};
  std::vector<std::string> texts;
  std::optional<CalibrationAnswer> last;

  explicit Ground(double seconds = 3.0) { run(seconds); }
  void run(double seconds) {
    for (long i = std::lround(1000 * seconds); i > 0; --i) {
      vehicle.step(flight);
      if (const auto answer = flight.calibrator().take_answer()) last = answer;
      const CalibrationText said = flight.calibrator().take_text();
      if (said.text != nullptr) texts.emplace_back(said.text);
    }
  }
  int result() const { return last ? last->result : -1; }
};

// 4000 samples of 1.2 mrad/s: 0.02 mrad/s. The vehicle model's bias is 50, -30, 20 mrad/s.
TEST(Calibrator, TheGyrosZeroPointBecomesParameters) {
  Ground ground;
  EXPECT_EQ(ground.flight.calibrate(Calibration::gyro), Reason::none);
  ground.run(0.1);
  EXPECT_EQ(ground.result(), CalibrationAnswer::in_progress);
  ground.run(4.5);
  EXPECT_EQ(ground.result(), CalibrationAnswer::accepted);
  EXPECT_EQ(ground.last->percent, 100);
  const double want[] = {0.05, -0.03, 0.02};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(Parameter::cal_gyro_x_radps) + i;
    EXPECT_TRUE(near(ground.flight.parameters().value(row), want[i], stated(1e-4, "noise")));
  }
  EXPECT_EQ(ground.texts.back(), "calibration: gyro done");
  // From now on samples come without it, and the estimator finds the rest anew.
  ground.run(0.01);
  EXPECT_TRUE(near(ground.flight.estimator().imu().w_B_radps.x(), 0.0, stated(0.006, "5 sigma")));
  EXPECT_FALSE(ground.flight.estimator().calibrated());
  ground.run(1.5);
  EXPECT_TRUE(ground.flight.estimator().calibrated());
}

TEST(Calibrator, AGyroThatMovesIsRefusedAndNothingChanges) {
  Ground ground;
  ASSERT_EQ(ground.flight.calibrate(Calibration::gyro), Reason::none);
  ground.run(2.0);
  ground.vehicle.w_B_ = {0.0, 0.0, 0.5};
  ground.run(2.5);
  EXPECT_EQ(ground.result(), CalibrationAnswer::failed);
  EXPECT_EQ(ground.texts.back(), "calibration failed: it moved");
  EXPECT_EQ(ground.flight.parameters().changes(), 0u);
}

// A steady turn of 2 deg/s about the vertical is nothing to gyro and accelerometer, but the field turns.
TEST(Calibrator, TheFieldTellsASteadyTurn) {
  Parameters parameters;
  Calibrator calibrator(parameters);
  calibrator.start(Calibration::gyro);
  for (int ms = 0; ms < 3000; ++ms) {
    calibrator.on_imu({0.0f, 0.0f, -9.8f}, {0.0f, 0.0f, 0.035f});
    if (ms % 13 != 0) continue;
    const float turn = 0.035e-3f * static_cast<float>(ms);
    calibrator.on_field({24.0f * std::cos(turn), -24.0f * std::sin(turn), -53.0f}, {});
  }
  EXPECT_EQ(calibrator.running(), Calibration::none);
  EXPECT_EQ(parameters.changes(), 0u);
}

TEST(Calibrator, GivesUpWithoutANewSide) {
  Ground ground;
  ASSERT_EQ(ground.flight.calibrate(Calibration::accelerometer), Reason::none);
  ground.run(5.0);
  EXPECT_EQ(ground.texts.back(), "calibration: upright, done");
  EXPECT_EQ(ground.last->percent, 16);  // one of six
  ground.run(24.0);
  EXPECT_EQ(ground.result(), CalibrationAnswer::in_progress);
  ground.run(4.0);
  EXPECT_EQ(ground.result(), CalibrationAnswer::failed);
  EXPECT_EQ(ground.texts.back(), "calibration failed: sides are missing");
  EXPECT_EQ(ground.flight.parameters().changes(), 0u);
}

TEST(Calibrator, RunsOnlyDisarmedOneAtATimeAndKeepsItFromArming) {
  Ground ground;
  ASSERT_EQ(ground.flight.calibrate(Calibration::magnetometer), Reason::none);
  EXPECT_EQ(ground.flight.arm(), Reason::calibrating);
  EXPECT_EQ(ground.flight.calibrate(Calibration::gyro), Reason::calibrating);
  EXPECT_EQ(ground.flight.calibrate(Calibration::magnetometer), Reason::none);  // asked again
  EXPECT_EQ(ground.flight.calibrate(Calibration::none), Reason::none);
  ground.run(0.1);
  EXPECT_EQ(ground.result(), CalibrationAnswer::cancelled);
  ASSERT_EQ(ground.flight.arm(), Reason::none);
  for (const Calibration what : {Calibration::gyro, Calibration::accelerometer,
                                 Calibration::magnetometer, Calibration::motor_fields}) {
    EXPECT_EQ(ground.flight.calibrate(what), Reason::wrong_state);
  }
}

TEST(Calibrator, ASilentSensorEndsIt) {
  Ground ground;
  ASSERT_EQ(ground.flight.calibrate(Calibration::magnetometer), Reason::none);
  ground.vehicle.field_on_ = false;
  ground.run(0.5);
  EXPECT_EQ(ground.result(), CalibrationAnswer::failed);
  EXPECT_EQ(ground.flight.calibrate(Calibration::magnetometer), Reason::no_field);
}

// Armed while motors run: one of them, the others idle, none takes off; and disarmed at the end. The vehicle
// model's ESCs tell the same current always, by which nothing can be told.
TEST(Calibrator, RunsOneMotorAfterTheOtherOnTheGround) {
  Ground ground;
  ASSERT_EQ(ground.flight.calibrate(Calibration::motor_fields), Reason::none);
  EXPECT_EQ(ground.flight.state(), FlightState::armed);
  EXPECT_EQ(ground.flight.take_off(1.0f), Reason::calibrating);
  std::array<bool, 4> ran{};
  for (int i = 0; i < 26'000; ++i) {
    ground.run(0.001);
    const auto v = ground.flight.setpoints();
    int pulling = 0;
    for (std::size_t m = 0; m < 4; ++m) {
      pulling += v[m] > 1 ? 1 : 0;
      ran[m] = ran[m] || v[m] > 1;
      ASSERT_GE(v[m], 1);
    }
    ASSERT_LE(pulling, 1);
  }
  EXPECT_TRUE(ran[0] && ran[1] && ran[2] && ran[3]);
  EXPECT_LT(ground.vehicle.tilt_rad(), 0.03);
  EXPECT_EQ(ground.flight.state(), FlightState::armed);
  ground.run(2.0);
  EXPECT_EQ(ground.flight.state(), FlightState::disarmed);
  EXPECT_EQ(ground.result(), CalibrationAnswer::failed);
  EXPECT_EQ(ground.texts.back(), "calibration failed: not by the currents");
}

TEST(Calibrator, DisarmedOnTheWayTheMotorsStop) {
  Ground ground;
  ASSERT_EQ(ground.flight.calibrate(Calibration::motor_fields), Reason::none);
  ground.run(4.5);
  EXPECT_EQ(ground.flight.arm(), Reason::calibrating);  // it is, but not to fly
  ASSERT_EQ(ground.flight.disarm(), Reason::none);
  ground.run(0.1);
  EXPECT_EQ(ground.result(), CalibrationAnswer::failed);
  for (const std::uint16_t v : ground.flight.setpoints()) EXPECT_EQ(v, 0);
}

// Numbers worked out by hand.
TEST(SensorCorrection, ActsAsItsHeaderSays) {
  Parameters p;
  const auto put = [&p](Parameter first, std::vector<float> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_TRUE(p.set(static_cast<std::size_t>(first) + i, values[i], false)) << i;
    }
  };
  SensorCorrection c;
  EXPECT_FALSE(c.load(p));  // nothing to correct
  put(Parameter::cal_gyro_x_radps, {0.1f, -0.2f, 0.3f});
  put(Parameter::cal_accel_x_mps2, {0.5f, 0.0f, -0.25f});
  put(Parameter::cal_accel_scale_x, {1.05f, 1.0f, 0.95f});
  EXPECT_TRUE(c.load(p));
  EXPECT_FALSE(c.load(p));
  put(Parameter::cal_mag_x_uT, {10.0f, 0.0f, -20.0f});
  put(Parameter::cal_mag_scale_x, {1.1f, 1.0f, 0.9f});
  put(Parameter::cal_mag_xy, {0.1f, 0.0f, -0.2f});
  put(Parameter::cal_motor_1x_uTpA, {1.0f, 0.0f, 0.0f});
  put(Parameter::cal_motor_4x_uTpA, {0.0f, 2.0f, 0.0f});
  EXPECT_FALSE(c.load(p));  // not of the inertial sensor
  const Vector3 a = c.acceleration({10.5f, 2.0f, -10.25f});
  EXPECT_TRUE(near((a - Vector3(10.5f, 2.0f, -9.5f)).norm(), 0.0, stated(1e-5, "float")));
  const Vector3 w = c.rate({0.1f, 0.0f, 0.0f});
  EXPECT_TRUE(near((w - Vector3(0.0f, 0.2f, -0.3f)).norm(), 0.0, stated(1e-6, "float")));
  // m - c - k I = (35 - 10 - 5, 14 - 4, -30 + 20) = (20, 10, -10)
  const Vector3 m = c.field({35.0f, 14.0f, -30.0f}, {5.0f, 7.0f, 9.0f, 2.0f});
  EXPECT_TRUE(near((m - Vector3(23.0f, 14.0f, -11.0f)).norm(), 0.0, stated(1e-5, "float")));
}

// ---- Over the radio

mavlink::Frame command(std::array<float, 7> param) {
  mavlink::Message m(mavlink::kCommandLong, 33);
  for (std::size_t i = 0; i < 7; ++i) m.put(4 * i, param[i]);
  m.put<std::uint16_t>(28, 241).put<std::uint8_t>(30, 1).put<std::uint8_t>(31, 1);
  mavlink::Parser parser;
  for (const std::uint8_t byte : m.frame(255, 190, 0)) {
    if (parser.push(byte)) return parser.frame();
  }
  ADD_FAILURE() << "no frame";
  return {};
}

TEST(CalibrationRequest, OneParameterAsksForOne) {
  EXPECT_EQ(calibration_asked(command({1})), Calibration::gyro);
  EXPECT_EQ(calibration_asked(command({0, 1})), Calibration::magnetometer);
  EXPECT_EQ(calibration_asked(command({0, 0, 0, 0, 1})), Calibration::accelerometer);
  EXPECT_EQ(calibration_asked(command({0, 0, 0, 0, 0, 1})), Calibration::motor_fields);
  EXPECT_EQ(calibration_asked(command({})), Calibration::none);
  EXPECT_EQ(calibration_asked(command({1, 1})), std::nullopt);
  EXPECT_EQ(calibration_asked(command({2})), std::nullopt);
  EXPECT_EQ(calibration_asked(command({0, 0, 1})), std::nullopt);  // pressure
}

TEST(CalibrationRequest, IsAnsweredAtOnceAndAtTheEnd) {
  Ground ground;
  Telemetry telemetry(ground.flight);
  mavlink::Parser parser;
  std::vector<int> results;
  const auto run = [&](double seconds) {
    for (int i = 0; i < std::lround(200 * seconds); ++i) {
      for (int ms = 0; ms < 5; ++ms) ground.vehicle.step(ground.flight);
      for (const std::uint8_t byte : telemetry.next(10'000, {}, {})) {
        if (!parser.push(byte)) continue;
        const mavlink::Frame& f = parser.frame();
        if (f.id == mavlink::kCommandAck) results.push_back(f.get<std::uint8_t>(2));
      }
    }
  };
  const auto ask = [&](std::array<float, 7> param) {
    mavlink::Message m(mavlink::kCommandLong, 33);
    for (std::size_t i = 0; i < 7; ++i) m.put(4 * i, param[i]);
    m.put<std::uint16_t>(28, 241).put<std::uint8_t>(30, 1).put<std::uint8_t>(31, 1);
    telemetry.receive(m.frame(255, 190, 0));
  };
  run(1.0);
  ask({1});
  run(0.3);
  ASSERT_FALSE(results.empty());
  EXPECT_EQ(results.front(), 5);
  ask({0, 1});
  run(0.3);
  // Temporarily rejected: one runs.
  EXPECT_EQ(std::count(results.begin(), results.end(), 1), 1);
  run(5.0);
  EXPECT_EQ(results.back(), 0);
  ask({1, 1});
  run(0.3);
  EXPECT_EQ(results.back(), 3);
}

}  // namespace
}  // namespace fw
