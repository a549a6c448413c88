// A bridge's chip in memory, at the host's time: what a report takes in virtual time, whoever waits for it waits.
#pragma once
#include <algorithm>
#include <memory>
#include <type_traits>

#include "harness/pacing/host_clock.hpp"
#include "io_bridges/hid/emulated/memory_hid_port.hpp"

namespace whirl::bench {

class LiveHidPort final : public io::HidPort {
 public:
  // begin_ns: of the host, the queue's zero.
  LiveHidPort(io::EventQueue& queue, io::EmulatedHid& device, io::HidCable& cable,
              std::int64_t begin_ns)
      : queue_(queue), port_(queue, device, cable), begin_ns_(begin_ns) {}

  Result<Done> write(std::span<const std::uint8_t> report) override {
    return live([&] { return port_.write(report); });
  }
  Result<io::HidReport> read(std::int64_t timeout_ns) override {
    return live([&] { return port_.read(timeout_ns); });
  }
  Result<io::HidReport> get_feature(std::uint8_t number, std::size_t length) override {
    return live([&] { return port_.get_feature(number, length); });
  }
  Result<Done> set_feature(std::span<const std::uint8_t> report) override {
    return live([&] { return port_.set_feature(report); });
  }
  Result<io::HidReport> report_descriptor() override { return port_.report_descriptor(); }
  std::int64_t now_ns() const override { return clock_.now_ns(); }
  void pause_ns(std::int64_t duration_ns) override {
    live([&] {
      port_.pause_ns(duration_ns);
      return 0;
    });
  }

 private:
  template <typename Act>
  std::invoke_result_t<Act> live(Act act) {
    queue_.run_until(std::max(queue_.now(), clock_.now_ns() - begin_ns_));
    auto done = act();
    clock_.sleep_until(begin_ns_ + queue_.now());
    return done;
  }

  io::EventQueue& queue_;
  io::MemoryHidPort port_;
  std::int64_t begin_ns_;
  pacing::MonotonicClock clock_;
};

}  // namespace whirl::bench
