// Whole pulses from what a timer keeps of its edges, looked at once a millisecond.
#include "firmware/esc/core/pulse_edges.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fw::esc {
namespace {

// TIM1 as PWM input: a rise keeps the count and begins it anew, a fall keeps it; both say how often.
class Line {
 public:
  void edge(bool rise, int t_us) {
    const auto count = static_cast<std::uint32_t>(t_us - risen_us_);
    if (rise) {
      seen_.period_us = count;
      ++seen_.rises;
      risen_us_ = t_us;
    } else {
      seen_.width_us = count;
      ++seen_.falls;
    }
  }
  Captured look() {
    Captured seen = seen_;
    if (seen.rises > 2) seen.rises = 2;
    if (seen.falls > 2) seen.falls = 2;
    seen_.rises = seen_.falls = 0;
    return seen;
  }

 private:
  Captured seen_;
  int risen_us_ = 0;
};

struct High {
  int rise_us, fall_us;
};

// Looks at every millisecond and `phase_us`.
std::vector<Pulse> seen_of(const std::vector<High>& train, int phase_us) {
  Line line;
  PulseEdges edges;
  std::vector<Pulse> all;
  int look_us = phase_us;
  const auto look_before = [&](int t_us) {
    for (; look_us < t_us; look_us += 1000) {
      if (Pulse pulse; edges.look(line.look(), pulse)) all.push_back(pulse);
    }
  };
  for (const High& high : train) {
    look_before(high.rise_us);
    line.edge(true, high.rise_us);
    look_before(high.fall_us);
    line.edge(false, high.fall_us);
  }
  look_before(look_us + 1001);
  return all;
}

TEST(PulseEdges, EachPeriodHasTheWidthOfItsOwnPulseWhereverTheLooksFall) {
  std::vector<High> train;  // pulses of 1500 us, spikes of 950 us between them
  for (int t = 20'000; t < 200'000; t += 20'000) {
    train.push_back({t, t + 1500});
    train.push_back({t + 9000, t + 9950});
  }
  for (int phase_us = 0; phase_us < 1000; phase_us += 5) {
    const auto all = seen_of(train, phase_us);
    ASSERT_EQ(all.size(), train.size());
    for (std::size_t i = 1; i < all.size(); ++i) {
      EXPECT_EQ(all[i].width_us, i % 2 == 1 ? 1500u : 950u) << phase_us;
      EXPECT_EQ(all[i].period_us, i % 2 == 1 ? 9000u : 11'000u) << phase_us;
    }
  }
}

TEST(PulseEdges, ABreakOrASpikeWithinAMillisecondIsNeverAWholePulse) {
  for (const int second_us : {50, 300, 900}) {  // low after 600 us, and high for so long again
    for (int phase_us = 0; phase_us < 1000; phase_us += 5) {
      const auto all =
          seen_of({{20'000, 20'600}, {20'650, 20'650 + second_us}, {40'000, 41'500}}, phase_us);
      for (const Pulse& pulse : all) {
        const bool piece = pulse.period_us == 0 || pulse.period_us == 650;
        const bool rest = pulse.width_us == static_cast<unsigned>(second_us);
        EXPECT_TRUE(piece || rest || pulse.width_us == 0) << phase_us << ", " << pulse.width_us;
      }
    }
  }
}

TEST(PulseEdges, FindsTheLevelAgainAfterMoreEdgesThanItCanTell) {
  for (int phase_us = 0; phase_us < 1000; phase_us += 5) {
    const auto all = seen_of({{20'000, 20'020},
                              {20'040, 20'060},
                              {20'080, 20'100},
                              {20'120, 23'000},
                              {40'000, 41'500},
                              {60'000, 61'500}},
                             phase_us);
    ASSERT_FALSE(all.empty());
    EXPECT_EQ(all.back().width_us, 1500u);
    EXPECT_EQ(all.back().period_us, 20'000u);
  }
}

}  // namespace
}  // namespace fw::esc
