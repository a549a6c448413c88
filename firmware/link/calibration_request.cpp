#include "firmware/link/calibration_request.hpp"

namespace fw {

std::optional<Calibration> calibration_asked(const mavlink::Frame& command_long) {
  using enum Calibration;
  constexpr Calibration kByParam[] = {gyro,          magnetometer, none, none,
                                      accelerometer, motor_fields, none};
  Calibration what = none;
  for (std::size_t i = 0; i < std::size(kByParam); ++i) {
    const auto param = command_long.get<float>(4 * i);
    if (param == 0.0f) continue;
    if (param != 1.0f || kByParam[i] == none || what != none) return std::nullopt;
    what = kByParam[i];
  }
  return what;
}

}  // namespace fw
