// Runs one calibration at a time, as the ground station asks for it, and tells how far it is.
//
//   Gyro           its mean over 4 s at rest; moved meanwhile: failed. The field must stay, too, as a steady
//                  turn about the vertical changes nothing else
//   Accelerometer  accelerometer_calibration.hpp, in the hand
//   Magnetometer   magnetometer_calibration.hpp, in the hand
//   Motor fields   motor_field_calibration.hpp, armed on the ground: the flight logic asks motor() what turns
//   Patience       30 s without a new side or part of the sphere: failed
//   Result         parameters, all in one tick, so that one record in flash holds the whole set
//   Told           texts, and an answer (MAV_RESULT) at each tenth of the way
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "firmware/calibration/accelerometer_calibration.hpp"
#include "firmware/calibration/magnetometer_calibration.hpp"
#include "firmware/calibration/motor_field_calibration.hpp"
#include "firmware/calibration/sensor_correction.hpp"
#include "firmware/config/parameters.hpp"

namespace fw {

enum class Calibration : std::uint8_t { none, gyro, accelerometer, magnetometer, motor_fields };

struct CalibrationAnswer {
  enum Result : std::uint8_t { accepted = 0, failed = 4, in_progress = 5, cancelled = 6 };
  Result result = in_progress;
  std::uint8_t percent = 0;
};
struct CalibrationText {
  const char* text = nullptr;  // null: none
  bool bad = false;
};

class Calibrator {
 public:
  explicit Calibrator(Parameters& parameters) : parameters_(parameters) {}

  void start(Calibration what);  // pre: nothing runs
  // Something keeps it from going on; says what.
  void fail(const char* why);
  void cancel();
  void answer_again() { answer_ = {CalibrationAnswer::in_progress, shown_percent_}; }

  Calibration running() const { return running_; }
  int motor() const {  // 0..3 that shall pull kThrust_N, -1 none
    return running_ == Calibration::motor_fields ? motor_fields_.motor() : -1;
  }

  // As the sensors read, uncorrected.
  void on_imu(const Vector3& a_B_mps2, const Vector3& w_B_radps);  // 1 kHz
  void on_field(const Vector3& m_B_uT, const MotorCurrents& current_A);
  void step(const Vector3& w_B_radps, float dt_s);  // the rate as it is estimated

  std::optional<CalibrationAnswer> take_answer();
  CalibrationText take_text();

 private:
  static constexpr std::size_t kTexts = 4;

  void say(const char* text, bool bad = false);
  void show(unsigned percent);
  void finish(CalibrationAnswer::Result result, const char* text);
  void on_still_gyro(const Vector3& a_B_mps2, const Vector3& w_B_radps);
  void on_side(AccelerometerCalibration::Side side);
  void finish_accelerometer();
  void finish_magnetometer();
  void finish_motor_fields();

  Parameters& parameters_;
  Calibration running_ = Calibration::none;
  StillWindow still_;
  AccelerometerCalibration accelerometer_;
  MagnetometerCalibration magnetometer_;
  MotorFieldCalibration motor_fields_;
  Vector3 field_first_uT_ = Vector3::Zero(), field_mean_uT_ = Vector3::Zero();
  int fields_ = 0;
  float waited_s_ = 0.0f;  // since there was something new
  std::optional<CalibrationAnswer> answer_;
  std::uint8_t shown_percent_ = 0;
  std::array<CalibrationText, kTexts> texts_{};
  std::size_t texts_due_ = 0;
};

}  // namespace fw
