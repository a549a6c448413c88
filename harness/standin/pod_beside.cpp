#include "harness/standin/pod_beside.hpp"

#include <algorithm>
#include <array>

#include "harness/standin/bare_board.hpp"
#include "harness/target/node_set.hpp"
#include "harness/target/virtual_board.hpp"

namespace whirl {
namespace {

constexpr std::int64_t kReady_ns = 100'000;  // as in test_plans/chain/pod.lua
constexpr const char *kSelect = "PA15", *kReady = "PC4";
constexpr std::array<const char*, 4> kBuses{"spi1", "i2c1", "i2c2", "i2c3"};  // of the pod

// Where the pod plays that part; nothing: it does not.
std::optional<int> port_of(const BoardDevice& device) {
  if (device.type == "mpu6000") return 0;
  if (device.type == "ms5611" || device.type == "hmc5883l") return 1;
  if (device.type == "esc_i2c") return device.motor <= 2 ? 2 : 3;
  return std::nullopt;
}

std::vector<WireEnd> leading_ends(const BoardDescription& board, int fd) {
  std::vector<WireEnd> ends;
  for (const BoardDevice& device : board.devices) {
    const auto port = port_of(device);
    if (!port) continue;
    ends.push_back({.device = device.name, .fd = fd, .port = *port, .latency_ns = kReady_ns});
  }
  return ends;
}

std::vector<WireEnd> following_ends(int fd) {
  std::vector<WireEnd> ends;
  for (std::size_t i = 0; i < kBuses.size(); ++i) {
    ends.push_back({.bus = kBuses[i],
                    .fd = fd,
                    .port = static_cast<int>(i),
                    .shared = true,
                    .select = i == 0 ? kSelect : "",
                    .ready = i == 0 ? kReady : "",
                    .latency_ns = kReady_ns});
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
  std::vector<NodeSet::Entry> nodes;
  nodes.push_back(entry("flight", bare_board(boards.flight), boards.flight_image,
                        leading_ends(boards.flight, fd)));
  nodes.push_back(entry("pod", bare_board(boards.pod), boards.pod_image, following_ends(fd)));
  std::vector<BoardWireLink> links;
  links.push_back({0, 1, std::move(wire.value())});
  return std::unique_ptr<Target>(
      std::make_unique<NodeSet>(std::move(nodes), std::vector<UartWire>{}, std::move(links)));
}

}  // namespace whirl
