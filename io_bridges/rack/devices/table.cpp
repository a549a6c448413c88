#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {

const DeviceTypes& device_types() {
#define WHIRL_CALL(name) name##_type(),
  static const DeviceTypes types = {WHIRL_DEVICE_TYPES(WHIRL_CALL)};
#undef WHIRL_CALL
  return types;
}

}  // namespace whirl::rack
