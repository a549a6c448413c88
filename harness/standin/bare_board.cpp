#include "harness/standin/bare_board.hpp"

#include <algorithm>
#include <set>

#include "io_bridges/board_description/line_part.hpp"
#include "io_bridges/board_description/pod_host.hpp"
#include "io_bridges/devices/core/receiver.hpp"
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

// A receiver's end of its UART, for whoever plays it through an inverter.
BoardDevice line_of_receiver(const BoardDevice& receiver) {
  BoardDevice line{
      .name = receiver.name, .type = "serial", .bus = receiver.bus, .place = receiver.place};
  line.set("baud", double{core::receiver::kSbusBaud});
  line.set("params.frame", std::string("8E2"));
  return line;
}

// Nobody tells here to what rate its player is set.
BoardDevice line_of_gps(const BoardDevice& gps) {
  BoardDevice line{.name = gps.name, .type = "serial", .bus = gps.bus, .place = gps.place};
  line.set("baud", gps.value("baud").value_or(9600.0));
  line.set("params.follows", true);
  return line;
}

// What is left where a pod's host was.
BoardDevice end_of_host(const BoardDevice& host) {
  if (const auto can = can_of_host(host)) {
    return {.name = host.name,
            .type = "can_port",
            .bus = "can" + std::to_string(*can),
            .place = host.place};
  }
  BoardDevice line{.name = host.name,
                   .type = "serial",
                   .bus = "usart" + std::to_string(kPodHostUart),
                   .place = host.place};
  line.set("baud", io::kPodBaud);
  return line;
}

}  // namespace

BoardDescription bare_board(BoardDescription board) {
  std::set<std::string> buses;
  for (BoardDevice& device : board.devices) {
    if (device.type == "mavlink_link") device = line_of(device);
    if (is_receiver(device)) device = line_of_receiver(device);
    if (is_gps(device)) device = line_of_gps(device);
    if (is_pod_host(device)) device = end_of_host(device);
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
