#include "harness/target/bench/node_link.hpp"

#include <algorithm>

namespace whirl::bench {
namespace {

constexpr std::size_t kMost_waiting = 64;
constexpr int kMost_arrivals = 256;          // of a turn: who floods the bus must not hold the loop
constexpr std::int64_t kRetry_ns = 200'000;  // a frame of eight bytes takes 130 us at 1 Mbit/s

}  // namespace

NodeLink::NodeLink(NodeOptions options, CanMaker maker)
    : RackLink(rack_, options.pod),
      options_(std::move(options)),
      end_(options_.link, std::move(maker), options_.log),
      rack_(options_.link.bus, options_.link.bit_rate_bps, options_.seed,
            [this](const io::CanFrame& frame) {
              node_.on_own(frame);
              add_waiting(frame);
            }),
      node_({.node = options_.link.allocator, .ids = options_.link.ids},
            [this](const io::CanFrame& frame) { add_waiting(frame); }) {}

void NodeLink::add_waiting(const io::CanFrame& frame) {
  if (safe_) return;
  if (waiting_.size() < kMost_waiting) {
    waiting_.push_back(frame);
  } else {
    ++dropped_;
  }
}

Result<Done> NodeLink::open() {
  const std::string wire = "can" + std::to_string(options_.link.bus);
  if (const auto built = build(options_.board, options_.types, wire); !built) return built;
  return end_.open();
}

Result<Done> NodeLink::take_in(std::int64_t /*now_host_ns*/) {
  for (int n = 0; n < kMost_arrivals; ++n) {
    const auto got = end_.receive();
    if (!got) return got.error();
    if (!got.value()) break;
    if (got.value()->own) continue;
    advance(got.value()->host_ns);
    node_.on_frame(got.value()->frame, virtual_ns(got.value()->host_ns));
    rack_.give(got.value()->frame);
  }
  return Done{};
}

Result<Done> NodeLink::send_waiting(std::int64_t now_host_ns) {
  node_.poll(virtual_ns(now_host_ns));
  for (; !waiting_.empty(); waiting_.pop_front()) {
    const auto sent = end_.send(waiting_.front());
    if (!sent) return sent.error();
    if (sent.value()) continue;
    retry_host_ns_ = now_host_ns + kRetry_ns;
    break;
  }
  return Done{};
}

std::int64_t NodeLink::next_due_host_ns() const {
  const std::int64_t due_ns = RackLink::next_due_host_ns();
  return waiting_.empty() ? due_ns : std::min(due_ns, retry_host_ns_);
}

void NodeLink::make_safe() {
  safe_ = true;
  waiting_.clear();
}

std::vector<std::string> NodeLink::findings() const {
  auto all = end_.findings();
  for (const std::string& finding : node_.findings()) {
    all.push_back(options_.link.interface + ": " + finding);
  }
  if (dropped_ > 0) {
    all.push_back(std::to_string(dropped_) + " frames of the nodes found no room at " +
                  options_.link.interface);
  }
  add_pod_findings(all);
  return all;
}

}  // namespace whirl::bench
