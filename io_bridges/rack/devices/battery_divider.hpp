// The divider from a battery to an ADC's pin: what the firmware knows is the nominal ratio; the resistors are drawn from
// their tolerance.
#pragma once
#include <vector>

#include "io_bridges/rack/device_type.hpp"

namespace whirl::rack {

std::vector<DeviceKey> divider_keys();  // params.top, .bottom, .tolerance

class BatteryDivider {
 public:
  // Pre: the slot's type has those keys.
  explicit BatteryDivider(DeviceSlot& slot);

  double tap_V(double battery_V) const {
    return battery_V * bottom_ohm_ / (top_ohm_ + bottom_ohm_);
  }
  double source_ohm() const { return top_ohm_ * bottom_ohm_ / (top_ohm_ + bottom_ohm_); }

 private:
  double top_ohm_, bottom_ohm_;
};

}  // namespace whirl::rack
