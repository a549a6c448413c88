// Node ids for nodes that have none: uavcan.protocol.dynamic_node_id.Allocation, the allocator's side.
//
//   Exchange   a node without id sends its 16-byte unique id in three parts (6, 6, 4 bytes), each once the allocator
//              has sent back what it has so far; with the third part it gets the whole and its node id
//   Time-out   500 ms between parts: then the exchange begins anew
//   Ids        what was kept for that unique id; else what the node asked for if it is free, or the next lower one of the
//              range, or the next higher one; from the top of the range downwards if it asked for none.
//              The same unique id gets the same node id again. 126 and 127 are left to tools
//   Source     facts of dronecan/DSDL, uavcan/protocol/dynamic_node_id/1.Allocation
//   Left out   redundant allocators; a table that outlives the program
#pragma once
#include <bitset>
#include <optional>
#include <utility>
#include <vector>

#include "io_bridges/protocols/dronecan/data_type.hpp"
#include "io_bridges/protocols/dronecan/fields.hpp"
#include "io_bridges/protocols/dronecan/node.hpp"

namespace whirl::io::dronecan {

struct Allocation {
  static constexpr DataType kType{Kind::message, 1, 0x0B2A812620A11D40, 17, "Allocation"};
  static constexpr std::int64_t kTime_out_ns = 500'000'000;
  std::uint8_t node_id = 0;  // 0: any
  bool first_part = false;
  Bounded<std::uint8_t, 16> unique_id{};

  template <typename F>
  void layout(F& f) {
    f.u(node_id, 7);
    f.u(first_part, 1);
    f.tail(unique_id, 8, [&](std::uint8_t& byte) { f.u(byte, 8); });
  }
};

class Allocator {
 public:
  struct Counts {
    std::uint64_t requests = 0, granted = 0, timed_out = 0;
    std::uint64_t out_of_turn = 0;  // a part that follows nothing, or of a wrong length
    std::uint64_t full = 0;         // no id is free
  };
  static constexpr std::uint8_t kHighest_id = 125;

  // Gives ids of lowest..highest. Pre: 1 <= lowest <= highest <= kHighest_id.
  explicit Allocator(std::uint8_t lowest = 1, std::uint8_t highest = kHighest_id)
      : lowest_(lowest), highest_(highest) {}

  // Only the node of this unique id gets it; it may lie outside of the range.
  void keep(const UniqueId& id, std::uint8_t node_id);
  // This id is in use and will not be given.
  void occupied(std::uint8_t node_id) { taken_.set(node_id & 0x7F); }
  // A request, of a node without id. The answer to send, if there is one.
  std::optional<Allocation> on_request(const Allocation& request, std::int64_t now_ns);
  // Of all that have been given, or are kept.
  const std::vector<std::pair<UniqueId, std::uint8_t>>& given() const { return given_; }
  const Counts& counts() const { return counts_; }

 private:
  std::uint8_t choose(const UniqueId& id, std::uint8_t wanted);

  std::uint8_t lowest_, highest_;
  std::bitset<128> taken_;
  std::vector<std::pair<UniqueId, std::uint8_t>> given_;
  Bounded<std::uint8_t, 16> so_far_{};
  std::int64_t last_ns_ = 0;
  Counts counts_;
};

}  // namespace whirl::io::dronecan
