#include "harness/target/bench/bridge_link.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <tuple>

#include "base/check.hpp"
#include "harness/pacing/host_clock.hpp"

namespace whirl::bench {
namespace {

constexpr std::int64_t kSafe_every_ns = 10'000'000;

std::int64_t now_host_ns() {
  return pacing::MonotonicClock().now_ns();
}

// libstdc++'s steady clock is CLOCK_MONOTONIC.
std::chrono::steady_clock::time_point at(std::int64_t host_ns) {
  return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(host_ns));
}

}  // namespace

BridgeThread::BridgeThread(BridgeOptions options, std::unique_ptr<I2cPort> port)
    : options_(std::move(options)), port_(std::move(port)) {
  options_.safe.urgent = true;
}

BridgeThread::~BridgeThread() {
  close();
}

Result<Done> BridgeThread::open() {
  if (const auto opened = port_->open(); !opened) return opened;
  version_ = port_->version();
  woken_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  WHIRL_CHECK(woken_ >= 0);
  heard_host_ns_ = now_host_ns();
  port_->stop_when([this] {
    const std::scoped_lock lock(mutex_);
    return is_safe(now_host_ns());
  });
  thread_ = std::thread([this] { work(); });
  return Done{};
}

bool BridgeThread::take(const io::Reader& order, std::int64_t due_host_ns) {
  if (order.header().kind != io::Kind::i2c_order || order.header().port != options_.bus) {
    return false;
  }
  const auto head = order.as<io::I2cOrder>();
  const auto bytes = order.tail_after(sizeof head);
  const std::scoped_lock lock(mutex_);
  orders_.push_back(
      {due_host_ns,
       head.number,
       {static_cast<std::uint8_t>(head.address), {bytes.begin(), bytes.end()}, head.read}});
  changed_.notify_one();
  return true;
}

Result<Done> BridgeThread::serve(std::int64_t now_host_ns, Arrivals& arrivals) {
  eventfd_t count = 0;
  std::ignore = ::eventfd_read(woken_, &count);
  const std::scoped_lock lock(mutex_);
  heard_host_ns_ = now_host_ns;
  std::move(answers_.begin(), answers_.end(), std::back_inserter(arrivals));
  answers_.clear();
  if (error_) return *error_;
  return Done{};
}

bool BridgeThread::is_safe(std::int64_t now_host_ns) {
  const bool silent =
      options_.heartbeat_ns > 0 && now_host_ns >= heard_host_ns_ + options_.heartbeat_ns;
  if (!safe_ && silent) {
    safe_ = alone_ = true;
    orders_.clear();
    next_safe_ns_ = now_host_ns;
  }
  return safe_;
}

bool BridgeThread::next(std::unique_lock<std::mutex>& lock, Order& order) {
  for (;;) {
    if (ending_) return false;
    const std::int64_t now = now_host_ns();
    std::int64_t wake_ns = is_safe(now)                ? next_safe_ns_
                           : options_.heartbeat_ns > 0 ? heard_host_ns_ + options_.heartbeat_ns
                                                       : kNever_ns;
    if (safe_ && now >= next_safe_ns_) {
      next_safe_ns_ = now + kSafe_every_ns;
      order = {now, 0, options_.safe};
      return true;
    }
    if (!safe_ && !orders_.empty()) {
      if (orders_.front().due_host_ns <= now) {
        order = std::move(orders_.front());
        orders_.pop_front();
        return true;
      }
      wake_ns = std::min(wake_ns, orders_.front().due_host_ns);
    }
    if (wake_ns == kNever_ns) {
      changed_.wait(lock);
    } else {
      changed_.wait_until(lock, at(wake_ns));
    }
  }
}

void BridgeThread::work() {
  std::unique_lock lock(mutex_);
  Order order;
  while (next(lock, order)) {
    lock.unlock();
    const auto outcome = port_->transfer(order.transfer);
    lock.lock();
    if (!order.transfer.urgent) answer(order, outcome);
    if (outcome) continue;
    error_ = outcome.error();
    std::ignore = ::eventfd_write(woken_, 1);
    return;
  }
  std::ignore = port_->transfer(options_.safe);
}

void BridgeThread::answer(const Order& order, const Result<TransferOutcome>& outcome) {
  if (!outcome) return;
  const io::I2cReplyHead head{.number = order.number,
                              .acked = outcome.value().acked,
                              .timed_out = outcome.value().timed_out};
  std::vector<std::uint8_t> payload(sizeof head);
  std::memcpy(payload.data(), &head, sizeof head);
  const std::vector<std::uint8_t>& bytes = outcome.value().bytes;
  payload.insert(payload.end(), bytes.begin(), bytes.end());
  answers_.push_back(
      {outcome.value().end_host_ns, io::Kind::i2c_reply, options_.bus, std::move(payload)});
  std::ignore = ::eventfd_write(woken_, 1);
}

void BridgeThread::make_safe() {
  const std::scoped_lock lock(mutex_);
  if (safe_) return;
  safe_ = true;
  orders_.clear();
  next_safe_ns_ = 0;
  changed_.notify_one();
}

bool BridgeThread::heartbeat_lost() const {
  const std::scoped_lock lock(mutex_);
  return alone_;
}

void BridgeThread::close() {
  if (!thread_.joinable()) return;
  {
    const std::scoped_lock lock(mutex_);
    ending_ = true;
    changed_.notify_one();
  }
  thread_.join();
  port_->close();
  ::close(woken_);
  woken_ = -1;
}

std::vector<std::pair<std::string, std::string>> BridgeThread::versions() const {
  return {{"link " + options_.name, version_}};
}

}  // namespace whirl::bench
