// What of a part's faults acts where a pod plays it: those that are a matter of the data that its host sends, and of what the
// host can tell the pod. A register that does not answer, a wire, the pod's own conversion times are not among them.
//
//   Places   parts behind a pod's host are on a bus of their own, kPodBus, each at the address of its type
#pragma once
#include <optional>
#include <string>

#include "io_bridges/devices/faults.hpp"

namespace whirl::rack {

inline constexpr int kPodBus = 0x7000;
enum PodAddress : int {
  kPodImu = 1,
  kPodBarometer,
  kPodMagnetometer,
  kPodGps,
  kPodReceiver,
  kPodBattery
};

// Of a device type that a pod can play: "mpu6000". Nothing: faults of it find nothing there.
std::optional<int> pod_address(const std::string& type);
// Of a part that a pod plays, or a bench on the part's own serial line.
bool acts_in_data(const std::string& type, io::FaultKind kind);

}  // namespace whirl::rack
