// See toy_device.cpp.
#pragma once
#include "io_bridges/rack/device_type.hpp"

namespace whirl::board_test {

rack::DeviceType toy_type();

}  // namespace whirl::board_test
