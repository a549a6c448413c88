#include "io_bridges/protocols/dronecan/types.hpp"

#include <algorithm>

#include "io_bridges/protocols/dronecan/allocation.hpp"
#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/gnss.hpp"
#include "io_bridges/protocols/dronecan/imu_samples.hpp"
#include "io_bridges/protocols/dronecan/param.hpp"
#include "io_bridges/protocols/dronecan/pod.hpp"
#include "io_bridges/protocols/dronecan/sensors.hpp"
#include "io_bridges/protocols/dronecan/vehicle_state.hpp"

namespace whirl::io::dronecan {
namespace {

constexpr DataType kTypes[] = {
    GetNodeInfoRequest::kType,
    GetNodeInfoResponse::kType,
    GetSetRequest::kType,
    GetSetResponse::kType,
    Allocation::kType,
    NodeStatus::kType,
    RawCommand::kType,
    RpmCommand::kType,
    EscStatus::kType,
    RawImu::kType,
    MagneticFieldStrength2::kType,
    StaticPressure::kType,
    StaticTemperature::kType,
    Fix2::kType,
    BatteryInfo::kType,
    ArmingStatus::kType,
    Imu14::kType,
    Imu16::kType,
    PodSample::kType,
    PodFrame::kType,
    PodSetpoint::kType,
};

}  // namespace

std::span<const DataType> all_types() {
  return kTypes;
}

const DataType* known_type(Kind kind, std::uint16_t type_id) {
  const auto* found = std::find_if(std::begin(kTypes), std::end(kTypes), [&](const DataType& type) {
    return type.kind == kind && type.id == type_id;
  });
  return found == std::end(kTypes) ? nullptr : found;
}

}  // namespace whirl::io::dronecan
