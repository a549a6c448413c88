#include "firmware/calibration/calibrator.hpp"

#include <algorithm>

namespace fw {
namespace {

// At rest a block of 50 ms scatters by 0.3 mrad/s and 0.015 m/s^2; a hand, or wind that rocks it, by far more.
constexpr StillWindow::Limits kAtRest{0.15f, 0.01f, 80};
// By the data sheet +-20 deg/s at 25 degC, and as much by temperature [MPU-6000 rev 3.4, table 6.1].
constexpr float kMostGyro_radps = 0.7f;
constexpr float kPatience_s = 30.0f;
// A field's running mean of some 20 samples scatters by 0.05 uT.
constexpr float kFieldTurned_uT = 1.0f, kFieldShare = 0.1f;
constexpr int kFieldsToSettle = 30;

const char* text_of(AccelerometerCalibration::Side side) {
  switch (side) {
    case AccelerometerCalibration::Side::nose:
      return "calibration: nose up, done";
    case AccelerometerCalibration::Side::tail:
      return "calibration: nose down, done";
    case AccelerometerCalibration::Side::right_side:
      return "calibration: right side up, done";
    case AccelerometerCalibration::Side::left_side:
      return "calibration: left side up, done";
    case AccelerometerCalibration::Side::belly:
      return "calibration: upside down, done";
    case AccelerometerCalibration::Side::top:
      return "calibration: upright, done";
    case AccelerometerCalibration::Side::none:
      break;
  }
  return "";
}

}  // namespace

void Calibrator::start(Calibration what) {
  running_ = what;
  waited_s_ = 0.0f;
  shown_percent_ = 0;
  fields_ = 0;
  answer_ = CalibrationAnswer{};
  switch (what) {
    case Calibration::none:
      return;
    case Calibration::gyro:
      still_.restart();
      return say("calibration: gyro, keep it still");
    case Calibration::accelerometer:
      accelerometer_.start();
      return say("calibration: hold each of six sides up, still");
    case Calibration::magnetometer:
      magnetometer_.start();
      return say("calibration: turn it all round");
    case Calibration::motor_fields:
      motor_fields_.start();
      return say("calibration: motors run, keep clear");
  }
}

void Calibrator::say(const char* text, bool bad) {
  if (texts_due_ < kTexts) texts_[texts_due_++] = {text, bad};
}

void Calibrator::show(unsigned percent) {
  if (percent / 10 == shown_percent_ / 10u) return;
  shown_percent_ = static_cast<std::uint8_t>(std::min(percent, 99u));
  answer_ = {CalibrationAnswer::in_progress, shown_percent_};
}

void Calibrator::finish(CalibrationAnswer::Result result, const char* text) {
  const bool good = result == CalibrationAnswer::accepted;
  answer_ = {result, good ? std::uint8_t{100} : shown_percent_};
  say(text, result == CalibrationAnswer::failed);
  running_ = Calibration::none;
}

void Calibrator::fail(const char* why) {
  if (running_ != Calibration::none) finish(CalibrationAnswer::failed, why);
}

void Calibrator::cancel() {
  if (running_ != Calibration::none) finish(CalibrationAnswer::cancelled, "calibration: cancelled");
}

void Calibrator::on_imu(const Vector3& a_B_mps2, const Vector3& w_B_radps) {
  if (running_ == Calibration::gyro) on_still_gyro(a_B_mps2, w_B_radps);
  if (running_ == Calibration::accelerometer) on_side(accelerometer_.add(a_B_mps2, w_B_radps));
}

void Calibrator::on_still_gyro(const Vector3& a_B_mps2, const Vector3& w_B_radps) {
  switch (still_.add(a_B_mps2, w_B_radps, kAtRest)) {
    case StillWindow::Now::moved:
      return fail("calibration failed: it moved");
    case StillWindow::Now::gathering:
      return show(static_cast<unsigned>(100 * still_.blocks() / kAtRest.blocks));
    case StillWindow::Now::complete:
      break;
  }
  const Vector3& offset = still_.w_mean_B_radps();
  if (!(offset.cwiseAbs().maxCoeff() < kMostGyro_radps)) {
    return fail("calibration failed: beyond the data sheet");
  }
  keep_gyro(parameters_, offset);
  finish(CalibrationAnswer::accepted, "calibration: gyro done");
}

void Calibrator::on_side(AccelerometerCalibration::Side side) {
  if (side == AccelerometerCalibration::Side::none) return;
  waited_s_ = 0.0f;
  say(text_of(side));
  const unsigned done = accelerometer_.sides_done();
  show(100 * done / AccelerometerCalibration::kSides);
  if (done == AccelerometerCalibration::kSides) finish_accelerometer();
}

void Calibrator::finish_accelerometer() {
  Vector3 offset, scale;
  if (!accelerometer_.solve(offset, scale))
    return fail("calibration failed: beyond the data sheet");
  keep_accelerometer(parameters_, offset, scale);
  finish(CalibrationAnswer::accepted, "calibration: accelerometer done");
}

void Calibrator::on_field(const Vector3& m_B_uT, const MotorCurrents& current_A) {
  if (running_ == Calibration::gyro) {
    field_mean_uT_ =
        fields_ == 0 ? m_B_uT : field_mean_uT_ + kFieldShare * (m_B_uT - field_mean_uT_);
    if (++fields_ == kFieldsToSettle) field_first_uT_ = field_mean_uT_;
    if (fields_ > kFieldsToSettle && (field_mean_uT_ - field_first_uT_).norm() > kFieldTurned_uT) {
      fail("calibration failed: it moved");
    }
  } else if (running_ == Calibration::magnetometer) {
    if (magnetometer_.add(m_B_uT)) waited_s_ = 0.0f;
    show(99 * magnetometer_.cells_seen() / MagnetometerCalibration::kCells);
    if (magnetometer_.seen_enough()) finish_magnetometer();
  } else if (running_ == Calibration::motor_fields) {
    motor_fields_.add(m_B_uT, current_A);
  }
}

void Calibrator::finish_magnetometer() {
  Vector3 centre;
  Matrix3 W;
  if (!magnetometer_.solve(centre, W)) return fail("calibration failed: no even field");
  keep_magnetometer(parameters_, centre, W);
  finish(CalibrationAnswer::accepted, "calibration: magnetometer done");
}

void Calibrator::finish_motor_fields() {
  std::array<Vector3, 4> k_uTpA;
  if (!motor_fields_.solve(k_uTpA)) return fail("calibration failed: not by the currents");
  keep_motor_fields(parameters_, k_uTpA);
  finish(CalibrationAnswer::accepted, "calibration: motor fields done");
}

void Calibrator::step(const Vector3& w_B_radps, float dt_s) {
  waited_s_ += dt_s;
  if (running_ == Calibration::motor_fields) {
    motor_fields_.step(w_B_radps, dt_s);
    show(static_cast<unsigned>(99.0f * std::min(motor_fields_.share_done(), 1.0f)));
    if (motor_fields_.done()) finish_motor_fields();
  } else if (waited_s_ > kPatience_s) {
    fail(running_ == Calibration::accelerometer ? "calibration failed: sides are missing"
                                                : "calibration failed: not seen all round");
  }
}

std::optional<CalibrationAnswer> Calibrator::take_answer() {
  const auto answer = answer_;
  answer_.reset();
  return answer;
}

CalibrationText Calibrator::take_text() {
  if (texts_due_ == 0) return {};
  const CalibrationText first = texts_[0];
  --texts_due_;
  std::copy_n(texts_.begin() + 1, texts_due_, texts_.begin());
  return first;
}

}  // namespace fw
