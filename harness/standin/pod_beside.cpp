#include "harness/standin/pod_beside.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "harness/board/node.hpp"
#include "harness/standin/bare_board.hpp"
#include "harness/target/node_set.hpp"
#include "harness/target/virtual_board.hpp"

namespace whirl {
namespace {

constexpr const char *kSelect = "PA15", *kReady = "PC4";

// Where the pod plays a part, and what passes at least between the boards' knowing of each other: of SPI its line of
// data-ready, as in test_plans/chain/pod.lua; of a UART a character of ten bits at its
// fastest rate, which may be off by 3 %.
struct Seat {
  const char *type, *bus;
  std::int64_t latency_ns = 0;
};
constexpr std::array<Seat, 7> kSeats{{{"mpu6000", "spi1", 100'000},
                                      {"ms5611", "i2c1"},
                                      {"hmc5883l", "i2c1"},
                                      {"esc_i2c", "i2c2"},  // of motors 1 and 2
                                      {"esc_i2c", "i2c3"},
                                      {"ublox_6", "usart6", (97 * 1'000'000'000LL) / (10 * 57'600)},
                                      {"sbus", "usart2", (97 * 1'000'000'000LL) / (10 * 100'000)}}};

const Seat* seat_of(const BoardDevice& device, const std::set<std::string>& played) {
  for (const Seat& seat : kSeats) {
    if (device.type != seat.type) continue;
    const bool other_bus = (device.motor > 2) != (std::string_view(seat.bus) == "i2c3");
    if (device.type == "esc_i2c" && other_bus) continue;
    return played.count(seat.type) != 0 ? &seat : nullptr;
  }
  return nullptr;
}

struct Ends {
  std::vector<WireEnd> leading, following;
};

// What joins two boards is one wire, with a port for each bus of the pod.
Ends ends_of(const PodBeside& boards, int fd) {
  Ends ends;
  const auto played = pod_parts(boards.pod);
  for (const BoardDevice& device : boards.flight.devices) {
    const Seat* seat = seat_of(device, played);
    if (seat == nullptr) continue;
    const auto known = std::find_if(ends.following.begin(), ends.following.end(),
                                    [&](const WireEnd& end) { return end.bus == seat->bus; });
    const auto port = static_cast<int>(known - ends.following.begin());
    ends.leading.push_back(
        {.device = device.name, .fd = fd, .port = port, .latency_ns = seat->latency_ns});
    if (known != ends.following.end()) continue;
    const bool spi = std::string_view(seat->bus).starts_with("spi");
    ends.following.push_back({.bus = seat->bus,
                              .fd = fd,
                              .port = port,
                              .shared = true,
                              .select = spi ? kSelect : "",
                              .ready = spi ? kReady : "",
                              .latency_ns = seat->latency_ns});
  }
  return ends;
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
  const int fd = wire.value().fd();
  Ends ends = ends_of(boards, fd);
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
