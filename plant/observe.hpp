// What sensors see of a vehicle's state.
#pragma once
#include "plant/sensors/imu.hpp"
#include "plant/sensors/truth.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {

Truth observe(const VehicleState& state);
ImuMotion imu_motion(const VehicleState& state);

}  // namespace whirl::plant
