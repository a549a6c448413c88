#include "io_bridges/rack/devices/pod_battery.hpp"

#include <algorithm>
#include <utility>

#include "io_bridges/messages/messages.hpp"
#include "io_bridges/protocols/dronecan/pod_link.hpp"
#include "io_bridges/rack/devices/pod_faults.hpp"

namespace whirl::rack {
namespace {

constexpr double kSupply_V = 3.3;
constexpr Nanoseconds kAgain_ns = 1'000'000'000;

}  // namespace

std::vector<DeviceKey> pod_battery_keys() {
  std::vector<DeviceKey> keys = divider_keys();
  keys.push_back(
      flag_key("params.battery", "it brings the battery's level to an analog pin").with(false));
  return keys;
}

PodBattery::PodBattery(DeviceSlot& slot)
    : faults_(slot.rack().faults()),
      played_(slot.flag("params.battery")),
      divider_(slot),
      battery_V_(io::BodyMotion{}.bus_voltage_V) {}

std::optional<std::vector<std::uint8_t>> PodBattery::news(Nanoseconds now) {
  if (!played_) return std::nullopt;
  double battery_V = battery_V_;
  const io::Fault* offset = faults_.apply(io::FaultKind::sensor_offset, kPodBus, kPodBattery, now);
  if (offset != nullptr) battery_V = std::max(battery_V + offset->value, 0.0);
  const double level = divider_.tap_V(battery_V) / kSupply_V;
  auto frame = io::pack_pod_battery(0, level);
  if (frame == told_ && now - told_ns_ < kAgain_ns) return std::nullopt;
  told_ = std::move(frame);
  told_ns_ = now;
  return io::pack_pod_battery(number_++, level);
}

}  // namespace whirl::rack
