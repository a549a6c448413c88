// MAV_CMD_PREFLIGHT_CALIBRATION of a COMMAND_LONG: which calibration it asks for.
//
//   Params  1 gyro, 2 magnetometer, 5 accelerometer, 6 the motors' fields ("compassmot"): 1 asks for it, one at
//           a time. None set: what runs is cancelled [mavlink.io, common.xml, command 241; QGroundControl]
//   Refused others, values other than 1, two at once
#pragma once
#include <optional>

#include "firmware/calibration/calibrator.hpp"
#include "firmware/link/mavlink.hpp"

namespace fw {

inline constexpr std::uint16_t kPreflightCalibration = 241;  // MAV_CMD_PREFLIGHT_CALIBRATION

std::optional<Calibration> calibration_asked(const mavlink::Frame& command_long);

}  // namespace fw
