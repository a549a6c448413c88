// The pulse train on its wire, edge by edge.
#include "io_bridges/devices/pulse_source.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace whirl::io {
namespace {

constexpr Nanoseconds kUs = 1'000;

struct Bench {
  Bench() {
    wire.watch([this](bool, Nanoseconds now) { edges_us.push_back(now / kUs); });
  }
  EventQueue queue;
  Wire wire{"pulses", false};
  PulseSource source{queue, wire};
  std::vector<Nanoseconds> edges_us;
};

TEST(PulseSource, RepeatsItsPulseAndTakesANewWidthAtTheNextPeriod) {
  Bench b;
  b.source.set({1200 * kUs, 20'000 * kUs, 0, 0});
  b.queue.run_until(500 * kUs);
  b.source.set({1500 * kUs, 20'000 * kUs, 0, 0});
  b.queue.run_until(41'000 * kUs);
  EXPECT_EQ(b.edges_us, (std::vector<Nanoseconds>{0, 1200, 20'000, 21'500, 40'000}));
}

TEST(PulseSource, WidthZeroIsSilenceAndLaterPulsesBeginAtOnce) {
  Bench b;
  b.source.set({1000 * kUs, 2'500 * kUs, 0, 0});
  b.queue.run_until(1'500 * kUs);
  b.source.set({0, 2'500 * kUs, 0, 0});
  b.queue.run_until(30'000 * kUs);
  EXPECT_EQ(b.edges_us, (std::vector<Nanoseconds>{0, 1000}));
  b.source.set({1000 * kUs, 2'500 * kUs, 0, 0});
  b.queue.run_until(31'500 * kUs);
  EXPECT_EQ(b.edges_us, (std::vector<Nanoseconds>{0, 1000, 30'000, 31'000}));
}

TEST(PulseSource, GlitchInvertsThePulseAndTheGap) {
  Bench b;
  b.source.set({1000 * kUs, 10'000 * kUs, 50 * kUs, 600 * kUs});
  b.queue.run_until(9'000 * kUs);
  EXPECT_EQ(b.edges_us, (std::vector<Nanoseconds>{0, 600, 650, 1000}));
  b.source.set({1000 * kUs, 10'000 * kUs, 50 * kUs, 4000 * kUs});
  b.edges_us.clear();
  b.queue.run_until(19'000 * kUs);
  EXPECT_EQ(b.edges_us, (std::vector<Nanoseconds>{10'000, 11'000, 14'000, 14'050}));
}

}  // namespace
}  // namespace whirl::io
