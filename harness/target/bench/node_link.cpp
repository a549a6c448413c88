#include "harness/target/bench/node_link.hpp"

#include <algorithm>

namespace whirl::bench {
namespace {

constexpr std::size_t kMost_waiting = 64;
constexpr int kMost_arrivals = 256;          // of a turn: who floods the bus must not hold the loop
constexpr std::int64_t kRetry_ns = 200'000;  // a frame of eight bytes takes 130 us at 1 Mbit/s
constexpr std::int64_t kGrain_ns = 50'000;   // of the host: not a turn for each event

}  // namespace

NodeLink::NodeLink(NodeOptions options, CanMaker maker)
    : options_(std::move(options)),
      end_(options_.link, std::move(maker), options_.log),
      rack_(options_.link.bus, options_.link.bit_rate_bps, options_.seed,
            [this](const io::CanFrame& frame) {
              if (safe_) return;
              if (waiting_.size() < kMost_waiting) {
                waiting_.push_back(frame);
              } else {
                ++dropped_;
              }
            }) {}

Result<Done> NodeLink::open() {
  if (const auto built = rack_.build(options_.board, options_.types); !built) return built;
  if (rack_.devices() == 0) {
    return Error{ErrorKind::bad_input, options_.board.name,
                 "has no device on can" + std::to_string(options_.link.bus) + " to be played", ""};
  }
  return end_.open();
}

bool NodeLink::take(const io::Reader& order, std::int64_t /*due_host_ns*/) {
  rack_.on_message(order);
  return false;
}

void NodeLink::advance(std::int64_t host_ns) {
  io::EventQueue& events = rack_.events();
  events.run_until(std::max(events.now(), time_.virtual_ns(host_ns)));
}

Result<Done> NodeLink::serve(std::int64_t now_host_ns, Arrivals& arrivals) {
  served_host_ns_ = now_host_ns;
  if (const auto taken = take_in(); !taken) return taken;
  advance(now_host_ns);
  if (const auto sent = send_waiting(now_host_ns); !sent) return sent;
  hand_over(arrivals);
  return Done{};
}

Result<Done> NodeLink::take_in() {
  for (int n = 0; n < kMost_arrivals; ++n) {
    const auto got = end_.receive();
    if (!got) return got.error();
    if (!got.value()) break;
    if (got.value()->own) continue;
    advance(got.value()->host_ns);
    rack_.give(got.value()->frame);
  }
  return Done{};
}

Result<Done> NodeLink::send_waiting(std::int64_t now_host_ns) {
  for (; !waiting_.empty(); waiting_.pop_front()) {
    const auto sent = end_.send(waiting_.front());
    if (!sent) return sent.error();
    if (sent.value()) continue;
    retry_host_ns_ = now_host_ns + kRetry_ns;
    break;
  }
  return Done{};
}

void NodeLink::hand_over(Arrivals& arrivals) {
  for (io::Reader r(rack_.happened().bytes()); r.next();) {
    const io::Header& head = r.header();
    arrivals.push_back({time_.due_host_ns(head.t_ns),
                        head.kind,
                        head.port,
                        {r.payload().begin(), r.payload().end()}});
  }
  rack_.happened().clear();
}

std::int64_t NodeLink::next_due_host_ns() const {
  const std::int64_t deadline_ns = rack_.events().next_deadline();
  std::int64_t due_ns = kNever_ns;
  if (deadline_ns != io::kNever) {
    due_ns = std::max(time_.due_host_ns(deadline_ns), served_host_ns_ + kGrain_ns);
  }
  return waiting_.empty() ? due_ns : std::min(due_ns, retry_host_ns_);
}

void NodeLink::make_safe() {
  safe_ = true;
  waiting_.clear();
}

std::vector<std::string> NodeLink::findings() const {
  auto all = end_.findings();
  if (dropped_ > 0) {
    all.push_back(std::to_string(dropped_) + " frames of the nodes found no room at " +
                  options_.link.interface);
  }
  return all;
}

}  // namespace whirl::bench
