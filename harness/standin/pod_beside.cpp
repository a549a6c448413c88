#include "harness/standin/pod_beside.hpp"

#include <algorithm>
#include <array>

#include "harness/board/node.hpp"
#include "harness/board/wire_ends.hpp"
#include "harness/standin/bare_board.hpp"
#include "harness/target/node_set.hpp"
#include "harness/target/virtual_board.hpp"
#include "io_bridges/board_description/bus_kind.hpp"

namespace whirl {
namespace {

constexpr const char *kSelect = "PA15", *kReady = "PC4";

// Where the pod plays a part, as docs/pod.md has its pins. Of its lines to GPS, receiver and radio the fastest that it speaks.
struct Seat {
  const char *type, *bus;
  double fastest_baud = 0.0;
};
constexpr std::array<Seat, 9> kSeats{{{"mpu6000", "spi1"},
                                      {"ms5611", "i2c1"},
                                      {"hmc5883l", "i2c1"},
                                      {"esc_i2c", "i2c2"},  // of motors 1 and 2
                                      {"esc_i2c", "i2c3"},
                                      {"ublox_6", "usart6", 57'600.0},
                                      {"sbus", "usart2", 100'000.0},
                                      {"mavlink_link", "usart3", 57'600.0},
                                      {"battery_sense", "dac1"}}};
constexpr std::int64_t kLine_ns = 100'000;  // of its lines, as in test_plans/chain/include/pod.lua

const Seat* seat_of(const BoardDevice& device) {
  for (const Seat& seat : kSeats) {
    if (device.type != seat.type) continue;
    const bool other_bus = (device.motor > 2) != (std::string_view(seat.bus) == "i2c3");
    if (device.type == "esc_i2c" && other_bus) continue;
    return &seat;
  }
  return nullptr;
}

std::vector<WirePlace> places_of(const PodBeside& boards) {
  std::vector<WirePlace> places;
  const auto played = pod_parts(boards.pod);
  for (const BoardDevice& device : boards.flight.devices) {
    const Seat* seat = seat_of(device);
    if (seat == nullptr || played.count(device.type) == 0) continue;
    WirePlace place{device.name, seat->bus};
    if (bus_kind(place.bus) == BusKind::spi) {
      place.select = kSelect;
      place.ready = kReady;
      place.latency_ns = kLine_ns;
    }
    if (bus_kind(place.bus) == BusKind::dac) place.latency_ns = kLine_ns;
    if (is_uart(place.bus)) place.latency_ns = shortest_character_ns(seat->fastest_baud);
    places.push_back(std::move(place));
  }
  return places;
}

NodeSet::Entry entry(const std::string& name, BoardDescription board, const std::string& image,
                     std::vector<WireEnd> wires) {
  VirtualBoardOptions options;
  options.board = {std::move(board),
                   {.image = image, .wires = std::move(wires), .seed = 1, .node = name}};
  return {name, std::make_unique<VirtualBoard>(std::move(options))};
}

}  // namespace

Result<std::unique_ptr<Target>> with_pod(const PodBeside& boards) {
  auto wire = io::BoardWire::create(2);
  if (!wire) return wire.error();
  WireEnds ends = wire_ends(places_of(boards), wire.value().fd());
  std::vector<NodeSet::Entry> nodes;
  nodes.push_back(
      entry("flight", bare_board(boards.flight), boards.flight_image, std::move(ends.leading)));
  nodes.push_back(
      entry("pod", bare_board(boards.pod), boards.pod_image, std::move(ends.following)));
  std::vector<BoardWireLink> links;
  links.push_back({0, 1, std::move(wire.value())});
  return std::unique_ptr<Target>(
      std::make_unique<NodeSet>(std::move(nodes), std::vector<UartWire>{}, std::move(links)));
}

}  // namespace whirl
