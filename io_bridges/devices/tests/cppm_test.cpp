// The sum signal by its edges. Widths as measured of receivers: 300 us pulses, 1000 to 2000 us from edge
// to edge, 22.5 ms a frame.
#include "io_bridges/devices/cppm.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"

namespace whirl::io {
namespace {

struct Bench {
  explicit Bench(CppmReceiver::Params p = {}) : params(p) {
    wire.watch([this](bool level, Nanoseconds now) { (level ? rises : falls).push_back(now); });
    receiver = std::make_unique<CppmReceiver>(queue, wire, params, &book);
  }
  void run_ms(int ms, bool transmitting = true) {
    for (int k = 0; k < ms; ++k) {
      if (transmitting && k % 20 == 0) receiver->on_sticks(sticks);
      queue.run_until(queue.now() + 1'000'000);
    }
  }
  // Distances of rising edges, in us, of the last whole frame.
  std::vector<double> last_frame(const std::vector<Nanoseconds>& edges) const {
    std::vector<double> frame, whole;
    for (std::size_t i = 1; i < edges.size(); ++i) {
      const double us = static_cast<double>(edges[i] - edges[i - 1]) * 1e-3;
      if (us > 3500.0) {
        whole = frame;
        frame.clear();
      } else {
        frame.push_back(us);
      }
    }
    return whole;
  }
  EventQueue queue;
  Wire wire{"PA10", false};
  FaultBook book;
  CppmReceiver::Params params;
  std::unique_ptr<CppmReceiver> receiver;
  StickPositions sticks{-1.0, 0.0, 1.0, 0.5};
  std::vector<Nanoseconds> rises, falls;
};

CppmReceiver::Params steady() {
  CppmReceiver::Params params;
  params.jitter_s = 0.0;
  return params;
}

TEST(Cppm, EightChannelsAreNinePulsesAFrame) {
  Bench bench(steady());
  bench.run_ms(200);
  EXPECT_EQ(bench.last_frame(bench.rises),
            (std::vector<double>{1000, 1500, 2000, 1750, 1500, 1500, 1500, 1500}));
  const auto n = bench.falls.size();
  EXPECT_EQ(bench.falls[n - 1] - bench.rises[n - 1], 300'000);
  // The same pulse of the frame before.
  EXPECT_EQ(bench.rises[n - 1] - bench.rises[n - 10], 22'500'000);
}

TEST(Cppm, NegativePolarityTurnsTheLineAndNotTheDistances) {
  CppmReceiver::Params params = steady();
  params.negative = true;
  Bench bench(params);
  bench.run_ms(200);
  EXPECT_EQ(bench.last_frame(bench.falls)[2], 2000.0);
  EXPECT_EQ(bench.rises[3] - bench.falls[2], 300'000);  // it idles high: its first edge is a rise
}

TEST(Cppm, ASlowClockMakesAllTimesLonger) {
  CppmReceiver::Params params = steady();
  params.clock_error = 0.01;
  Bench bench(params);
  bench.run_ms(200);
  EXPECT_EQ(bench.last_frame(bench.rises)[2], 2020.0);
  const auto n = bench.falls.size();
  EXPECT_EQ(bench.falls[n - 1] - bench.rises[n - 1], 303'000);
  EXPECT_EQ(bench.rises[n - 1] - bench.rises[n - 10], 22'725'000);
}

TEST(Cppm, TravelBeyondFullIsCutAndTheGapStays) {
  CppmReceiver::Params params = steady();
  params.channels = 12;
  Bench bench(params);
  bench.sticks.fill(3.0);
  bench.run_ms(300);
  const auto frame = bench.last_frame(bench.rises);
  ASSERT_EQ(frame.size(), 12u);
  EXPECT_EQ(frame[0], 2100.0);
  // 25.2 ms of channels and a gap of 4 ms: longer than 22.5 ms.
  const auto n = bench.rises.size();
  EXPECT_EQ(bench.rises[n - 1] - bench.rises[n - 14], 29'200'000);
}

TEST(Cppm, JitterIsOfTwoMicrosecondsAndDoesNotAddUp) {
  Bench bench;
  bench.run_ms(20'000);
  double squares = 0.0, worst_us = 0.0;
  const Nanoseconds first = bench.rises.front();
  std::size_t n = 0;
  for (std::size_t i = 0; i < bench.rises.size(); i += 9, ++n) {
    const double late_us =
        static_cast<double>(bench.rises[i] - first - static_cast<Nanoseconds>(n) * 22'500'000) *
        1e-3;
    squares += late_us * late_us;
    worst_us = std::max(worst_us, std::abs(late_us));
  }
  EXPECT_LT(worst_us, 20.0);
  // Of two edges, of which the first is always the same one.
  EXPECT_TRUE(near(std::sqrt(squares / static_cast<double>(n)), 2.0,
                   stated(2.2, "the first edge's own jitter")));
  EXPECT_GT(worst_us, 2.0);
}

TEST(Cppm, FailsafeStopsHoldsOrGoesToItsPositions) {
  const struct {
    Failsafe style;
    std::size_t pulses;  // in 400 ms
    double thrust_us;
  } kCases[] = {{Failsafe::stop, 0, 0.0}, {Failsafe::hold, 9, 2000.0}, {Failsafe::fixed, 9, 900.0}};
  for (const auto& c : kCases) {
    CppmReceiver::Params params = steady();
    params.link.failsafe = c.style;
    Bench bench(params);
    bench.run_ms(1000);
    bench.run_ms(600, false);
    bench.rises.clear();
    bench.run_ms(400, false);
    EXPECT_EQ(bench.rises.empty(), c.pulses == 0);
    if (c.pulses == 0) continue;
    EXPECT_EQ(bench.last_frame(bench.rises).at(2), c.thrust_us);
  }
}

TEST(Cppm, BeforeItHearsAnythingItIsSilentUnlessItsPositionsAreFixed) {
  CppmReceiver::Params params = steady();
  Bench holds(params);
  holds.run_ms(100, false);
  EXPECT_TRUE(holds.rises.empty());
  params.link.failsafe = Failsafe::fixed;
  Bench fixed(params);
  fixed.run_ms(100, false);
  EXPECT_EQ(fixed.last_frame(fixed.rises).at(2), 900.0);
}

TEST(Cppm, ALostLinkIsAFaultAndNewSticksDoNotArrive) {
  CppmReceiver::Params params = steady();
  params.link.failsafe = Failsafe::stop;
  Bench bench(params);
  int applied = 0;
  bench.book.on_applied([&applied](std::uint32_t, Nanoseconds) { ++applied; });
  bench.book.add({.number = 1, .kind = FaultKind::rc_link_lost, .start_ns = 1'000'000'000});
  bench.run_ms(1000);
  EXPECT_FALSE(bench.rises.empty());
  bench.run_ms(600);
  bench.rises.clear();
  bench.run_ms(400);
  EXPECT_TRUE(bench.rises.empty());
  EXPECT_EQ(applied, 1);
}

TEST(Cppm, AGlitchSpoilsOneChannelOfAFrame) {
  Bench bench(steady());
  bench.sticks.fill(0.0);
  bench.run_ms(100);
  bench.book.add({.number = 1, .kind = FaultKind::rc_glitch, .value = 1.0});
  bench.run_ms(100);
  const auto frame = bench.last_frame(bench.rises);
  EXPECT_EQ(std::count(frame.begin(), frame.end(), 1500.0), 7);
}

TEST(Cppm, NewSticksComeOneFrameOfTheRadioLater) {
  Bench bench(steady());
  bench.run_ms(500);
  bench.rises.clear();
  bench.sticks[0] = 1.0;
  const Nanoseconds moved = bench.queue.now();
  bench.run_ms(100);
  for (std::size_t i = 1; i < bench.rises.size(); ++i) {
    if (bench.rises[i] - bench.rises[i - 1] != 2'000'000) continue;
    if (i >= 2 && bench.rises[i - 1] - bench.rises[i - 2] < 3'500'000)
      continue;  // not the first channel
    EXPECT_GE(bench.rises[i - 1] - moved, 22'000'000);
    EXPECT_LE(bench.rises[i - 1] - moved, 45'000'000);
    return;
  }
  ADD_FAILURE() << "the new position never came";
}

}  // namespace
}  // namespace whirl::io
