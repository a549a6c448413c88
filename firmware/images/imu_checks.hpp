// What the image makes of an IMU's sample before it believes it.
#pragma once
#include <cstdint>

#include "firmware/config/vehicle.hpp"
#include "firmware/math.hpp"
#include "firmware/status.hpp"

namespace fw {

// From the sensor's axes to the body's.
inline Vector3 mounted(const float (&of_sensor)[3], const config::Mounting& m) {
  return {m.sign[0] * of_sensor[m.axis[0]], m.sign[1] * of_sensor[m.axis[1]],
          m.sign[2] * of_sensor[m.axis[2]]};
}

// The same for longer than noise allows: the sensor signals, and does not measure.
template <typename Raw>
bool is_frozen(const Raw& raw, Faults& faults) {
  constexpr std::uint32_t kFrozen_samples = 50;
  static constinit Raw last;
  static constinit std::uint32_t same = 0;
  same = raw == last ? same + 1 : 0;
  last = raw;
  if (same == kFrozen_samples) ++faults.imu_frozen;
  return same >= kFrozen_samples;
}

}  // namespace fw
