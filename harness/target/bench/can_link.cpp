#include "harness/target/bench/can_link.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>

#include "harness/pacing/host_clock.hpp"
#include "io_bridges/messages/can_message.hpp"
#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/transfer.hpp"
#include "io_bridges/protocols/dronecan/vehicle_state.hpp"

namespace whirl::bench {
namespace {

namespace dc = io::dronecan;

constexpr std::int64_t kZeros_every_ns = 10'000'000;
constexpr std::int64_t kRetry_ns = 200'000;  // a frame of eight bytes takes 130 us at 1 Mbit/s
constexpr std::size_t kMost_of_node = 128;   // who asks and asks must not have it grow
constexpr int kMost_arrivals = 256;          // of a turn: who floods the bus must not hold the loop
constexpr std::uint8_t kPriority =
    5;  // the set-points' own, so that these come behind none of them

std::chrono::steady_clock::time_point time_point_of(std::int64_t host_ns) {
  return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(host_ns));
}

std::int64_t host_now_ns() {
  return pacing::MonotonicClock().now_ns();
}

}  // namespace

CanLink::CanLink(CanOptions options, CanMaker maker)
    : options_(std::move(options)), end_(options_.link, std::move(maker), options_.log) {}

CanLink::~CanLink() {
  close();
}

Result<Done> CanLink::open() {
  if (auto opened = end_.open(); !opened) return opened;
  heard_host_ns_ = host_now_ns();
  thread_ = std::thread([this] { work(); });
  return Done{};
}

void CanLink::keep_time(BenchTime time) {
  const std::scoped_lock lock(mutex_);
  virtual_ns_ = std::move(time.virtual_ns);
  node_.emplace(BusNodeOptions{.node = options_.node, .arms = true, .ids = options_.link.ids},
                [this](const io::CanFrame& frame) {
                  if (!safe_ && node_waiting_.size() < kMost_of_node)
                    node_waiting_.push_back(frame);
                });
}

bool CanLink::take(const io::Reader& order, std::int64_t due_host_ns) {
  if (order.header().kind != io::Kind::can_order || order.header().port != options_.link.bus) {
    return false;
  }
  const std::scoped_lock lock(mutex_);
  if (!safe_) orders_.push_back({due_host_ns, io::frame_of(order.as<io::CanMessage>())});
  return true;
}

std::int64_t CanLink::next_due_host_ns() const {
  const std::scoped_lock lock(mutex_);
  if (!node_waiting_.empty()) return retry_host_ns_;
  if (orders_.empty()) return kNever_ns;
  return std::max(orders_.front().due_host_ns, retry_host_ns_);
}

Result<Done> CanLink::serve(std::int64_t now_host_ns, Arrivals& arrivals) {
  {
    const std::scoped_lock lock(mutex_);
    heard_host_ns_ = now_host_ns;
    turn_node(now_host_ns);
    if (const auto sent = send_due(now_host_ns); !sent) return sent;
  }
  return take_in(arrivals);
}

void CanLink::turn_node(std::int64_t now_host_ns) {
  if (safe_) node_waiting_.clear();
  if (node_ && !safe_) node_->poll(virtual_ns_(now_host_ns));
}

Result<Done> CanLink::send_due(std::int64_t now_host_ns) {
  while (!orders_.empty() && orders_.front().due_host_ns <= now_host_ns) {
    const auto sent = send(orders_.front().frame);
    if (!sent) return sent.error();
    if (!sent.value()) {
      retry_host_ns_ = now_host_ns + kRetry_ns;
      return Done{};
    }
    orders_.pop_front();
  }
  for (; !node_waiting_.empty(); node_waiting_.pop_front()) {
    const auto sent = send(node_waiting_.front());
    if (!sent) return sent.error();
    if (sent.value()) continue;
    retry_host_ns_ = now_host_ns + kRetry_ns;
    break;
  }
  return Done{};
}

Result<bool> CanLink::send(const io::CanFrame& frame) {
  const auto sent = end_.send(frame);
  if (!sent || !sent.value() || frame.length == 0) return sent;
  const std::uint8_t tail = frame.data[frame.length - 1u];
  next_transfer_id_[frame.id] = static_cast<std::uint8_t>((tail + 1) & dc::tail::kTransfer_id);
  return sent;
}

Result<Done> CanLink::take_in(Arrivals& arrivals) {
  for (int n = 0; n < kMost_arrivals; ++n) {
    const auto got = end_.receive();
    if (!got) return got.error();
    if (!got.value()) break;
    const io::CanArrival& arrival = *got.value();
    if (const std::scoped_lock lock(mutex_); node_ && !arrival.own) {
      node_->on_frame(arrival.frame, virtual_ns_(arrival.host_ns));
    }
    io::CanRecord record;
    record.start_ns = arrival.host_ns;
    record.frame = io::to_message(arrival.frame);
    record.sender = arrival.own ? 0 : -1;
    std::vector<std::uint8_t> payload(sizeof record);
    std::memcpy(payload.data(), &record, sizeof record);
    arrivals.push_back(
        {arrival.host_ns, io::Kind::can_transfer, options_.link.bus, std::move(payload)});
  }
  return Done{};
}

// An error of the port shows at the next turn; here nothing more can be done than to try.
void CanLink::send_zeros() {
  const auto send_one = [&](const auto& message, std::uint8_t priority) {
    dc::Header header{.type_id = std::decay_t<decltype(message)>::kType.id,
                      .priority = priority,
                      .source = options_.node};
    header.transfer_id = next_transfer_id_[dc::can_id(header, {})];
    const dc::Payload payload = dc::encode(message);
    dc::TransferFrames frames(header, std::decay_t<decltype(message)>::kType.signature,
                              payload.bytes());
    for (io::CanFrame frame; frames.next(frame);) std::ignore = send(frame);
  };
  dc::RawCommand raw;
  raw.commands.size = options_.escs;
  dc::RpmCommand rpm;
  rpm.speeds_rpm.size = options_.escs;
  send_one(raw, kPriority);
  send_one(rpm, kPriority);
  send_one(dc::ArmingStatus{}, 16);
}

void CanLink::make_safe() {
  const std::scoped_lock lock(mutex_);
  if (safe_ || !end_.is_open()) return;
  safe_ = true;
  orders_.clear();
  node_waiting_.clear();
  send_zeros();
  next_safe_ns_ = host_now_ns() + kZeros_every_ns;
  changed_.notify_one();
}

void CanLink::work() {
  std::unique_lock lock(mutex_);
  while (!ending_) {
    const std::int64_t now_ns = host_now_ns();
    const std::int64_t silent_from_ns = heard_host_ns_ + options_.heartbeat_ns;
    if (!safe_ && options_.heartbeat_ns > 0 && now_ns >= silent_from_ns) {
      safe_ = alone_ = true;
      orders_.clear();
      node_waiting_.clear();
      next_safe_ns_ = now_ns;
    }
    if (safe_ && now_ns >= next_safe_ns_) {
      send_zeros();
      next_safe_ns_ = now_ns + kZeros_every_ns;
    }
    if (safe_) {
      changed_.wait_until(lock, time_point_of(next_safe_ns_));
    } else if (options_.heartbeat_ns > 0) {
      changed_.wait_until(lock, time_point_of(silent_from_ns));
    } else {
      changed_.wait(lock);
    }
  }
  send_zeros();
}

bool CanLink::heartbeat_lost() const {
  const std::scoped_lock lock(mutex_);
  return alone_;
}

std::vector<std::string> CanLink::findings() const {
  auto all = end_.findings();
  if (!node_) return all;
  for (const std::string& finding : node_->findings()) {
    all.push_back(options_.link.interface + ": " + finding);
  }
  return all;
}

void CanLink::close() {
  if (!thread_.joinable()) return;
  {
    const std::scoped_lock lock(mutex_);
    ending_ = safe_ = true;
    changed_.notify_one();
  }
  thread_.join();
  end_.close();
}

}  // namespace whirl::bench
