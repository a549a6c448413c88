// A stand-in at work in a thread of its own, until it is stopped.
#pragma once
#include <gtest/gtest.h>

#include <thread>

#include "harness/pacing/host_clock.hpp"
#include "harness/standin/stand_in.hpp"
#include "harness/target/virtual_board.hpp"

namespace whirl {

class RunningStandIn {
 public:
  // clock: null: the host's.
  RunningStandIn(World& world, std::unique_ptr<Target> target, StandInOptions wires,
                 pacing::HostClock* clock = nullptr)
      : target_(std::move(target)),
        stand_in_(world, *target_, clock == nullptr ? clock_ : *clock, std::move(wires)),
        thread_([this] {
          const auto ran = stand_in_.run();
          EXPECT_TRUE(ran.ok()) << ran.error().message();
        }) {}
  ~RunningStandIn() { stop(); }
  void stop() {
    if (!thread_.joinable()) return;
    stand_in_.end();
    thread_.join();
  }
  StandIn& operator*() { return stand_in_; }
  StandIn* operator->() { return &stand_in_; }

 private:
  pacing::MonotonicClock clock_;
  std::unique_ptr<Target> target_;
  StandIn stand_in_;
  std::thread thread_;
};

}  // namespace whirl
