#include "harness/standin/bare_board.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "io_bridges/protocols/dronecan/pod_link.hpp"

namespace whirl {
namespace {

constexpr double kRadio_baud = 57'600.0;  // where the board file states none

BoardDevice line_of(const BoardDevice& radio) {
  const auto baud = radio.keys.find("baud");
  BoardDevice line{.name = radio.name, .type = "serial", .bus = radio.bus, .place = radio.place};
  line.set("baud", baud == radio.keys.end() ? KeyValue(kRadio_baud) : baud->second);
  return line;
}

}  // namespace

// Without the host; pre: it is one's.
void leave_host(BoardDevice& host) {
  const auto can = host.value("params.can");
  if (can && *can != KeyValue(0.0)) {
    const auto bus = "can" + std::to_string(std::lround(std::get<double>(*can)));
    host = {.name = host.name, .type = "can_port", .bus = bus, .place = host.place};
    return;
  }
  host = {.name = host.name, .type = "serial", .bus = "usart1", .place = host.place};
  host.set("baud", io::kPodBaud);
}

BoardDescription bare_board(BoardDescription board) {
  std::set<std::string> buses;
  for (BoardDevice& device : board.devices) {
    if (device.type == "mavlink_link") device = line_of(device);
    if (device.type == "pod_parts") leave_host(device);
    if (device.type.ends_with("_dronecan")) buses.insert(device.bus);
  }
  std::erase_if(board.devices,
                [](const BoardDevice& device) { return device.type.ends_with("_dronecan"); });
  for (const std::string& bus : buses) {
    board.devices.push_back({.name = bus + "_port", .type = "can_port", .bus = bus});
  }
  return board;
}

}  // namespace whirl
