// What the plant's IMU is behind an MPU-6000, as a board file says.
#pragma once
#include <vector>

#include "io_bridges/rack/device_type.hpp"
#include "plant/sensors/imu.hpp"

namespace whirl::rack {

void add_imu_keys(
    std::vector<DeviceKey>& keys);  // axes, params.place, params.gyroscope.scale_error, ...
// Pre: the slot's type has those keys.
plant::ImuParams imu_physics_of(const DeviceSlot& slot);

}  // namespace whirl::rack
