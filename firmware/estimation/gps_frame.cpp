#include "firmware/estimation/gps_frame.hpp"

namespace fw {
namespace {

// Beyond them a receiver is finding its satellites, or losing them. A LEA-6 that has settled states 3 m, and
// 15 m when its fix is new.
constexpr float kMostLevel_m = 6.0f, kMostDown_m = 12.0f, kMostSpeed_mps = 1.0f;

}  // namespace

bool GpsSolution::good() const {
  return fix_type == 3 && within_limits && level_accuracy_m < kMostLevel_m &&
         down_accuracy_m < kMostDown_m && speed_accuracy_mps < kMostSpeed_mps;
}

void GpsFrame::learn(const GpsSolution& solution) {
  if (known()) return;
  if (count_ == 0) latitude_sum_ = longitude_sum_ = height_sum_ = 0;
  latitude_sum_ += solution.latitude_e7_deg;
  longitude_sum_ += solution.longitude_e7_deg;
  height_sum_ += solution.height_mm;
  if (++count_ < kOriginFixes) return;
  latitude_e7_deg_ = static_cast<std::int32_t>(latitude_sum_ / kOriginFixes);
  longitude_e7_deg_ = static_cast<std::int32_t>(longitude_sum_ / kOriginFixes);
  height_mm_ = static_cast<std::int32_t>(height_sum_ / kOriginFixes);
  constexpr float kA_m = 6378137.0f, kE2 = 6.69438e-3f, kRad_per_e7 = 1e-7f * kPi / 180.0f;
  const float latitude_rad = kRad_per_e7 * static_cast<float>(latitude_e7_deg_);
  const float sine = std::sin(latitude_rad), root = std::sqrt(1.0f - kE2 * sine * sine);
  north_m_per_e7_ = kRad_per_e7 * kA_m * (1.0f - kE2) / (root * root * root);
  east_m_per_e7_ = kRad_per_e7 * kA_m / root * std::cos(latitude_rad);
}

// Differences of whole numbers: a float alone would know the place to half a metre.
Vector3 GpsFrame::local(const GpsSolution& solution) const {
  const auto difference = [](std::int32_t to, std::int32_t from) {
    return static_cast<float>(std::int64_t{to} - from);
  };
  // The date line lies between 179.9 and -179.9 degrees.
  constexpr float kTurn_e7 = 3.6e9f;
  float east_e7 = difference(solution.longitude_e7_deg, longitude_e7_deg_);
  if (std::abs(east_e7) > 0.5f * kTurn_e7) east_e7 -= std::copysign(kTurn_e7, east_e7);
  return {north_m_per_e7_ * difference(solution.latitude_e7_deg, latitude_e7_deg_),
          east_m_per_e7_ * east_e7, -1e-3f * difference(solution.height_mm, height_mm_)};
}

}  // namespace fw
