#include "firmware/estimation/height_filter.hpp"

namespace fw {
namespace {

constexpr float kPole_radps = 0.8f;
constexpr float kK4 = 3.0f * kPole_radps, kK5 = 3.0f * kPole_radps * kPole_radps,
                kK6 = kPole_radps * kPole_radps * kPole_radps;
constexpr float kUnlikely_m = 5.0f, kConvinced_s = 1.0f;
constexpr float kLeap_m = 3.0f, kReckoned_s = 3.0f;
constexpr float kDrawn_s = 5.0f;
constexpr float kLongest_s = 0.1f;  // after a gap the old error is not its length

// International standard atmosphere, troposphere: h = 44330.8 m (1 - (p / 101325 Pa)^0.190263).
float altitude_m(float pressure_Pa) {
  return 44330.8f * (1.0f - std::pow(pressure_Pa / 101325.0f, 0.190263f));
}

}  // namespace

void HeightFilter::zero(float pressure_Pa) {
  zero_m_ = altitude_m(pressure_Pa);
  ready_ = true;
  z_m_ = vz_mps_ = 0.0f;
  doubted_s_ = since_believed_s_ = last_error_m_ = drawn_mps_ = 0.0f;
}

void HeightFilter::predict(float a_down_mps2, float dt_s) {
  const float a = a_down_mps2 - bias_mps2_;
  z_m_ += dt_s * vz_mps_ + 0.5f * dt_s * dt_s * a;
  vz_mps_ += dt_s * a;
}

void HeightFilter::correct(float pressure_Pa, float since_last_s) {
  const float dt_s = std::min(since_last_s, kLongest_s);
  const float measured_m = zero_m_ - altitude_m(pressure_Pa);
  const float error_m = z_m_ - measured_m;
  drawn_mps_ -= dt_s / kDrawn_s * drawn_mps_;
  since_believed_s_ += since_last_s;
  if (!(std::abs(error_m) < kUnlikely_m)) return doubt(error_m, dt_s);
  doubted_s_ = since_believed_s_ = 0.0f;
  last_error_m_ = error_m;
  z_m_ -= dt_s * kK4 * error_m;
  vz_mps_ -= dt_s * kK5 * error_m;
  drawn_mps_ -= dt_s * kK5 * error_m;
  bias_mps2_ += dt_s * kK6 * error_m;
}

// Readings that are no numbers, or that leap about, convince nobody.
void HeightFilter::doubt(float error_m, float dt_s) {
  const bool holds = std::abs(error_m - last_error_m_) < kLeap_m;
  last_error_m_ = error_m;
  if (!holds || doubted_s_ <= 0.0f) {
    leapt_ = !holds && since_believed_s_ < kReckoned_s;
    doubted_s_ = 0.0f;
  }
  doubted_s_ += dt_s;
  if (doubted_s_ < kConvinced_s || !std::isfinite(error_m)) return;
  doubted_s_ = since_believed_s_ = last_error_m_ = 0.0f;
  if (leapt_) {
    zero_m_ += error_m;
    return;
  }
  z_m_ -= error_m;
  vz_mps_ = 0.0f;
}

}  // namespace fw
