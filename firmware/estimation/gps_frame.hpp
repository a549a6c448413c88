// A receiver's solutions, and the local frame that they are turned into.
//
//   Frame   W: north-east-down, flat, touches the WGS84 ellipsoid in its origin; 8 cm of height are left out at
//           1 km. Its origin is the mean of the first kOriginFixes good solutions of a vehicle at rest: what the
//           receiver was off then stays in it
//   Source  radii of curvature of WGS84 [NIMA TR8350.2]: M = a (1 - e2) / (1 - e2 sin2)^(3/2), N = a / sqrt(1 -
//           e2 sin2)
//   Valid   within some kilometres of the origin (float: 1 cm), not within a degree of the poles
#pragma once
#include <cstdint>

#include "firmware/math.hpp"

namespace fw {

struct GpsSolution {
  std::int32_t latitude_e7_deg = 0, longitude_e7_deg = 0, height_mm = 0;  // over the ellipsoid
  Vector3 v_W_mps = Vector3::Zero();
  // Standard deviations as the receiver states them.
  float level_accuracy_m = 0.0f, down_accuracy_m = 0.0f, speed_accuracy_mps = 0.0f;
  std::uint8_t fix_type = 0, satellites = 0;
  bool within_limits = false;  // the receiver's own
  float age_s = 0.0f;          // since it was measured

  bool good() const;
};

class GpsFrame {
 public:
  static constexpr int kOriginFixes = 25;  // 5 s

  void forget() { count_ = 0; }
  bool known() const { return count_ == kOriginFixes; }
  void learn(const GpsSolution& solution);  // one that counts for the origin, while it is not known
  Vector3 local(const GpsSolution& solution) const;

  std::int32_t latitude_e7_deg() const { return latitude_e7_deg_; }
  std::int32_t longitude_e7_deg() const { return longitude_e7_deg_; }
  std::int32_t height_mm() const { return height_mm_; }

 private:
  int count_ = 0;
  std::int64_t latitude_sum_ = 0, longitude_sum_ = 0, height_sum_ = 0;
  std::int32_t latitude_e7_deg_ = 0, longitude_e7_deg_ = 0, height_mm_ = 0;
  float north_m_per_e7_ = 0.0f, east_m_per_e7_ = 0.0f;
};

}  // namespace fw
