// Two boards that a wire joins, for tests: each with its own events, and in a thread of its own, as their processes
// would be.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <thread>
#include <vector>

#include "io_bridges/qemu/board/wire_ends.hpp"

namespace whirl::board {

inline constexpr Nanoseconds kGrain_ns = 1'000'000;

// As the board does between two boundaries.
inline void wired_step(io::EventQueue& events, WireEnds& ends, Nanoseconds from, Nanoseconds to,
                       const bool& closed) {
  ends.after_boundary(from, to);
  bool there = false;
  io::Event boundary(
      events, [&] { there = true, ends.at_boundary(to); }, io::Rank::boundary);
  boundary.at(to);
  events.run_until(to);
  EXPECT_TRUE(there || closed);
}

struct WiredBoard {
  io::EventQueue events;
  std::vector<io::Finding> findings;
  bool closed = false;
  WireEnds ends{
      {events, [this](const io::Finding& f) { findings.push_back(f); }, [this] { closed = true; }}};
  void step(Nanoseconds from, Nanoseconds to) { wired_step(events, ends, from, to, closed); }
};

template <typename Board>
class TwoBoards : public ::testing::Test {
 protected:
  int end() { return dup(wire_.value().fd()); }
  void run(int grains) {
    for (int k = 0; k < grains; ++k, now_ns_ += kGrain_ns) {
      std::thread follower([this] { there_.step(now_ns_, now_ns_ + kGrain_ns); });
      here_.step(now_ns_, now_ns_ + kGrain_ns);
      follower.join();
    }
  }

  Result<io::BoardWire> wire_ = io::BoardWire::create(99);
  Board here_, there_;
  Nanoseconds now_ns_ = 0;
};

}  // namespace whirl::board
