#include "harness/target/bench/bus_node.hpp"

#include <algorithm>
#include <cstdio>

#include "io_bridges/protocols/dronecan/vehicle_state.hpp"

namespace whirl::bench {
namespace {

namespace dc = io::dronecan;

constexpr const char* kBusNode_name = "whirl.bench";
constexpr std::int64_t kBusNode_arming_ns = 500'000'000;
constexpr std::uint8_t kBusNode_armingPriority = 16, kBusNode_allocationPriority = 30;

std::string hex_of(const dc::UniqueId& id) {
  std::string text;
  for (const std::uint8_t byte : id) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

}  // namespace

BusNode::BusNode(const BusNodeOptions& options, dc::LocalNode::FrameSink send)
    : arms_(options.arms), allocator_(options.ids.lowest, options.ids.highest) {
  if (options.node) {
    node_.emplace(*options.node, kBusNode_name, std::move(send));
    ours_.set(*options.node);
    allocator_.occupied(*options.node);
  }
  for (const auto& [unique_id, id] : options.ids.kept) allocator_.keep(unique_id, id);
}

void BusNode::poll(std::int64_t now_ns) {
  if (!begun_ns_) begun_ns_ = next_arming_ns_ = now_ns;
  if (!node_) return;
  node_->poll(now_ns);
  if (!arms_ || now_ns < next_arming_ns_) return;
  next_arming_ns_ = now_ns + kBusNode_arming_ns;
  node_->broadcast(dc::ArmingStatus{dc::ArmingStatus::kArmed}, kBusNode_armingPriority);
}

void BusNode::on_own(const io::CanFrame& frame) {
  const auto header = frame.extended && !frame.remote ? dc::parse_can_id(frame.id) : std::nullopt;
  if (!header || header->source == 0) return;
  ours_.set(header->source);
  allocator_.occupied(header->source);
}

void BusNode::on_frame(const io::CanFrame& frame, std::int64_t now_ns) {
  const auto header = frame.extended && !frame.remote ? dc::parse_can_id(frame.id) : std::nullopt;
  if (!header) return;
  if (header->source != 0 && ours_.test(header->source))
    return ours_twice_.set(header->source), void();
  if (header->source != 0) allocator_.occupied(header->source);
  if (const auto event = watch_.on_frame(frame, now_ns)) on_event(*event, header->source, now_ns);
  if (!node_) return;
  if (const dc::Transfer* transfer = node_->on_frame(frame, now_ns)) {
    on_transfer(*transfer, now_ns);
  }
}

void BusNode::on_event(dc::NodeEvent event, std::uint8_t node, std::int64_t now_ns) {
  if (event == dc::NodeEvent::two_of_one_id) return;
  if (event == dc::NodeEvent::restarted && !known_[node].restarted_ns) {
    known_[node].restarted_ns = now_ns;
  }
  if (node_) node_->request(dc::GetNodeInfoRequest{}, node);
}

void BusNode::on_transfer(const dc::Transfer& transfer, std::int64_t now_ns) {
  if (const auto info = node_->read<dc::GetNodeInfoResponse>(transfer)) {
    return on_info(transfer.header.source, *info);
  }
  const bool listened = begun_ns_ && now_ns - *begun_ns_ >= dc::NodeStatus::kLongest_period_ns;
  if (transfer.header.source != 0 || !listened) return;
  const auto request = node_->read<dc::Allocation>(transfer);
  const auto answer = request ? allocator_.on_request(*request, now_ns) : std::nullopt;
  if (!answer) return;
  node_->broadcast(*answer, kBusNode_allocationPriority);
  const std::pair given{answer->node_id, answer->unique_id.items};
  if (given.first != 0 && std::find(granted_.begin(), granted_.end(), given) == granted_.end()) {
    granted_.push_back(given);
  }
}

void BusNode::on_info(std::uint8_t node, const dc::GetNodeInfoResponse& info) {
  Known& known = known_[node];
  known.name = info.name_text();
  known.major = info.software_major;
  known.minor = info.software_minor;
  if (known.unique_id && *known.unique_id != info.unique_id) {
    known.other_unique_id = info.unique_id;
  } else {
    known.unique_id = info.unique_id;
  }
}

std::string BusNode::trouble_of(std::uint8_t node) const {
  const std::string id = std::to_string(node);
  const Known& known = known_[node];
  const dc::NodeWatch::Node& watched = watch_.node(node);
  if (ours_twice_.test(node)) return "another node has id " + id + ", which is this host's";
  if (known.other_unique_id) {
    return "two nodes have id " + id + ": their unique ids are " + hex_of(*known.unique_id) +
           " and " + hex_of(*known.other_unique_id);
  }
  if (watched.two_of_one_id) {
    return "two nodes have id " + id + ": their statuses are not those of one";
  }
  if (watched.restarts == 0) return {};
  char text[160];
  std::snprintf(text, sizeof text, "node %u restarted %u times in this run, first heard at %.1f s",
                node, watched.restarts, static_cast<double>(*known.restarted_ns) * 1e-9);
  return text;
}

std::vector<std::string> BusNode::findings() const {
  std::vector<std::string> all;
  for (std::size_t id = 1; id < known_.size(); ++id) {
    const auto node = static_cast<std::uint8_t>(id);
    if (const std::string trouble = trouble_of(node); !trouble.empty()) all.push_back(trouble);
  }
  if (allocator_.counts().full > 0) {
    all.push_back("a node without id asked for one, and none of the range is free");
  }
  return all;
}

std::vector<std::pair<std::string, std::string>> BusNode::figures() const {
  std::vector<std::pair<std::string, std::string>> all;
  for (std::size_t id = 1; id < known_.size(); ++id) {
    const auto node = static_cast<std::uint8_t>(id);
    const Known& known = known_[node];
    if (!watch_.node(node).seen) continue;
    std::string text = "has not said who it is";
    if (known.unique_id) {
      text = (known.name.empty() ? "(no name)" : known.name) + ", version " +
             std::to_string(known.major) + "." + std::to_string(known.minor) + ", unique id " +
             hex_of(*known.unique_id);
    }
    all.emplace_back("node " + std::to_string(node), text);
  }
  for (const auto& [id, unique_id] : granted_) {
    all.emplace_back("node id " + std::to_string(id) + " given to", hex_of(unique_id));
  }
  return all;
}

}  // namespace whirl::bench
