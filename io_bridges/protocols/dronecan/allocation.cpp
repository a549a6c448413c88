#include "io_bridges/protocols/dronecan/allocation.hpp"

#include <algorithm>

namespace whirl::io::dronecan {
namespace {

constexpr std::size_t kPart = 6;  // bytes of the first and the second one

}  // namespace

std::optional<Allocation> Allocator::on_request(const Allocation& request, std::int64_t now_ns) {
  ++counts_.requests;
  if (so_far_.size > 0 && now_ns - last_ns_ > Allocation::kTime_out_ns) {
    ++counts_.timed_out;
    so_far_.size = 0;
  }
  if (request.first_part) so_far_.size = 0;
  const bool follows = request.first_part == (so_far_.size == 0);
  const std::size_t left = so_far_.items.size() - so_far_.size;
  if (!follows || request.unique_id.size != std::min(kPart, left)) {
    ++counts_.out_of_turn;
    return std::nullopt;
  }
  for (const std::uint8_t byte : request.unique_id.all()) so_far_.add(byte);
  last_ns_ = now_ns;

  Allocation answer;
  answer.unique_id = so_far_;
  if (so_far_.size < so_far_.items.size()) return answer;
  so_far_.size = 0;
  answer.node_id = choose(answer.unique_id.items, request.node_id);
  if (answer.node_id == 0) return ++counts_.full, std::nullopt;
  ++counts_.granted;
  return answer;
}

void Allocator::keep(const UniqueId& id, std::uint8_t node_id) {
  taken_.set(node_id & 0x7F);
  given_.emplace_back(id, node_id);
}

std::uint8_t Allocator::choose(const UniqueId& id, std::uint8_t wanted) {
  const auto known =
      std::find_if(given_.begin(), given_.end(), [&](const auto& one) { return one.first == id; });
  if (known != given_.end()) return known->second;
  const int from = wanted == 0 ? highest_ : std::clamp(wanted, lowest_, highest_);
  const auto give = [&](int node_id) {
    if (taken_.test(static_cast<std::size_t>(node_id))) return false;
    taken_.set(static_cast<std::size_t>(node_id));
    given_.emplace_back(id, static_cast<std::uint8_t>(node_id));
    return true;
  };
  for (int node_id = from; node_id >= lowest_; --node_id) {
    if (give(node_id)) return given_.back().second;
  }
  for (int node_id = from + 1; node_id <= highest_; ++node_id) {
    if (give(node_id)) return given_.back().second;
  }
  return 0;
}

}  // namespace whirl::io::dronecan
