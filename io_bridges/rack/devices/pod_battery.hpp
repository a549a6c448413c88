// The battery's level that a pod brings to the flight controller's ADC, behind its host, where the board file asks for it: by
// the divider of battery_divider.hpp, in steps of the pod's DAC, of 3.3 V.
//
//   Faults   sensor_offset, as of a battery_sense
//   Left out the capacitor at the tap and noise: on copper they are the flight controller's own
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "io_bridges/rack/devices/battery_divider.hpp"

namespace whirl::rack {

std::vector<DeviceKey> pod_battery_keys();  // params.battery and those of the divider

class PodBattery {
 public:
  // Pre: the slot's type has those keys.
  explicit PodBattery(DeviceSlot& slot);

  void set(double battery_V) { battery_V_ = battery_V; }
  // The frame for the pod; nothing: it plays none, or has told this level within the last second.
  std::optional<std::vector<std::uint8_t>> news(Nanoseconds now);

 private:
  io::FaultBook& faults_;
  bool played_;
  BatteryDivider divider_;
  double battery_V_ = 0.0;
  std::vector<std::uint8_t> told_;  // as number 0
  Nanoseconds told_ns_ = 0;
  std::uint8_t number_ = 0;
};

}  // namespace whirl::rack
