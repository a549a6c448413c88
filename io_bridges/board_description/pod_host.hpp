// The device of a board that is the host of a pod, and how the two are joined.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "io_bridges/board_description/board_description.hpp"

namespace whirl {

inline constexpr std::uint16_t kPodHostUart =
    1;  // of the pod, for its host; questions and answers are named so on CAN as well

// Of the messages of a telemetry radio that a pod plays: as the flight controller's own has it.
inline constexpr std::uint16_t kPodRadioPort = 2;

inline bool is_pod_host(const BoardDevice& device) {
  return device.type == "pod_parts";
}

// The CAN bus that the host is on; nothing: it is on a serial line. Pre: it is one.
inline std::optional<int> can_of_host(const BoardDevice& host) {
  const auto can = host.value("params.can");
  if (!can || *can == KeyValue(0.0)) return std::nullopt;
  return static_cast<int>(std::get<double>(*can));
}

// The bus that a device hangs on: its own key, or of a host whose link is on CAN that one ("can2").
inline std::string bus_of(const BoardDevice& device) {
  const auto can = is_pod_host(device) ? can_of_host(device) : std::nullopt;
  return can ? "can" + std::to_string(*can) : device.bus;
}

}  // namespace whirl
