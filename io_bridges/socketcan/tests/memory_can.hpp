// A CAN bus in memory, and ports on it as SocketCAN gives them: what one sends, the others receive at once, and the
// sender marked as its own. Full queues, cut wires and error frames are played by hand.
#pragma once
#include <sys/eventfd.h>
#include <unistd.h>

#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "io_bridges/socketcan/can_port.hpp"

namespace whirl::io {

class MemoryCan {
 public:
  explicit MemoryCan(std::function<std::int64_t()> now_ns) : now_ns_(std::move(now_ns)) {}

  std::unique_ptr<CanPort> join() { return std::make_unique<Port>(*this); }
  bool full = false, unplugged = false;

  // From nobody of ours.
  void put(const CanFrame& frame) { deliver(frame, nullptr); }
  void put(const CanTrouble& trouble) {
    const std::scoped_lock lock(mutex_);
    for (Port* port : ports_) {
      CanArrival arrival;
      arrival.host_ns = now_ns_();
      arrival.trouble = trouble;
      port->add(arrival);
    }
  }
  // Of all ports, in order, with their times.
  std::vector<std::pair<std::int64_t, CanFrame>> seen() {
    const std::scoped_lock lock(mutex_);
    return seen_;
  }

 private:
  class Port final : public CanPort {
   public:
    explicit Port(MemoryCan& bus) : bus_(bus), woken_(::eventfd(0, EFD_NONBLOCK)) {
      const std::scoped_lock lock(bus_.mutex_);
      bus_.ports_.push_back(this);
    }
    ~Port() override {
      const std::scoped_lock lock(bus_.mutex_);
      std::erase(bus_.ports_, this);
      ::close(woken_);
    }
    Result<bool> send(const CanFrame& frame) override {
      if (bus_.unplugged)
        return Error{ErrorKind::host, "can0", "the CAN adapter was unplugged", ""};
      if (bus_.full) return false;
      bus_.deliver(frame, this);
      return true;
    }
    Result<std::optional<CanArrival>> receive() override {
      const std::scoped_lock lock(bus_.mutex_);
      if (arrivals_.empty()) {
        eventfd_t count = 0;
        std::ignore = ::eventfd_read(woken_, &count);
        return std::optional<CanArrival>();
      }
      CanArrival arrival = arrivals_.front();
      arrivals_.pop_front();
      return std::optional(arrival);
    }
    int file() const override { return woken_; }
    std::string version() const override { return "a bus in memory"; }
    void add(const CanArrival& arrival) {
      arrivals_.push_back(arrival);
      std::ignore = ::eventfd_write(woken_, 1);
    }

   private:
    MemoryCan& bus_;
    int woken_;
    std::deque<CanArrival> arrivals_;
  };

  void deliver(const CanFrame& frame, Port* from) {
    const std::scoped_lock lock(mutex_);
    seen_.emplace_back(now_ns_(), frame);
    for (Port* port : ports_) {
      CanArrival arrival;
      arrival.host_ns = now_ns_();
      arrival.own = port == from;
      arrival.frame = frame;
      port->add(arrival);
    }
  }

  std::function<std::int64_t()> now_ns_;
  std::mutex mutex_;
  std::vector<Port*> ports_;
  std::vector<std::pair<std::int64_t, CanFrame>> seen_;
};

}  // namespace whirl::io
