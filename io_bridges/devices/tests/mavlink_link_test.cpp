#include "io_bridges/devices/mavlink_link.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/near.hpp"
#include "io_bridges/protocols/mavlink_messages.hpp"

namespace whirl::io {
namespace {

constexpr Nanoseconds kByte_ns = 173'611;  // 10 bits at 57600 baud

struct Bench {
  EventQueue queue;
  std::vector<std::string> findings;
  MavlinkLink link;
  std::vector<std::uint8_t> to_mcu;
  std::vector<Nanoseconds> times;
  std::vector<Nanoseconds> frames;
  std::vector<std::vector<std::uint8_t>> delivered;
  std::vector<Nanoseconds> delivered_at;
  MavlinkSender sender{1, 1, 0};

  explicit Bench(const MavlinkLink::Params& params = {})
      : link(queue, params, [this](const Finding& f) { findings.push_back(f.what); }) {
    link.join([this](const UartByte& byte, const UartFormat&) {
      to_mcu.push_back(byte.value);
      times.push_back(queue.now());
    });
    link.on_frame([this](std::span<const std::uint8_t>, Nanoseconds t) { frames.push_back(t); });
    link.on_delivered([this](std::span<const std::uint8_t> frame, Nanoseconds t) {
      delivered.emplace_back(frame.begin(), frame.end());
      delivered_at.push_back(t);
    });
  }
  std::vector<std::uint8_t> heartbeat() {
    Heartbeat beat;
    beat.system_status = 4;
    return encode(pack(beat, sender));
  }
  void mcu_sends(const std::vector<std::uint8_t>& bytes, double baud = 57600.0) {
    for (const std::uint8_t byte : bytes) {
      queue.run_until(queue.now() + kByte_ns);
      link.receive({.value = byte}, {.baud = baud}, queue.now());
    }
  }
};

TEST(MavlinkLink, UplinkBytesComeAtTheBaudRateAndNotBeforeTheirTime) {
  Bench bench;
  const auto frame = bench.heartbeat();
  bench.link.send_frame(frame, 5'000'000);
  bench.queue.run_until(1'000'000'000);
  ASSERT_EQ(bench.to_mcu, frame);
  for (std::size_t i = 0; i < frame.size(); ++i) {
    EXPECT_EQ(bench.times[i], 5'000'000 + static_cast<Nanoseconds>(i + 1) * kByte_ns);
  }
}

TEST(MavlinkLink, TwoFramesAtOnceFollowEachOther) {
  Bench bench;
  const auto first = bench.heartbeat();
  bench.link.send_frame(first, 0);
  bench.link.send_frame(bench.heartbeat(), 0);
  bench.queue.run_until(1'000'000'000);
  EXPECT_EQ(bench.times.back(), 2 * static_cast<Nanoseconds>(first.size()) * kByte_ns);
}

TEST(MavlinkLink, TellsTheLastStopBitOfEachFrameThatReachedTheMcu) {
  Bench bench;
  const auto first = bench.heartbeat(), second = bench.heartbeat();
  const auto bytes = static_cast<Nanoseconds>(first.size());
  bench.link.send_frame(first, 5'000'000);
  bench.link.send_frame(second, 5'000'000);
  bench.queue.run_until(1'000'000'000);
  EXPECT_EQ(bench.delivered, (std::vector<std::vector<std::uint8_t>>{first, second}));
  const std::vector<Nanoseconds> at{5'000'000 + bytes * kByte_ns, 5'000'000 + 2 * bytes * kByte_ns};
  EXPECT_EQ(bench.delivered_at, at);

  Bench lossy({.uplink_loss = 1.0});
  lossy.link.send_frame(first, 0);
  lossy.queue.run_until(1'000'000'000);
  EXPECT_TRUE(lossy.delivered.empty());
}

TEST(MavlinkLink, LosesTheStatedShareOfFramesAlikeForOneSeed) {
  const auto arrived = [](std::uint64_t seed) {
    Bench bench({.uplink_loss = 0.05, .seed = seed});
    for (int i = 0; i < 2000; ++i) bench.link.send_frame(bench.heartbeat(), i * 10'000'000LL);
    bench.queue.run_until(30'000'000'000);
    EXPECT_TRUE(near(static_cast<double>(bench.link.counts().up_lost), 100.0,
                     stated(4 * 9.75, "four standard deviations")));
    return bench.times;
  };
  EXPECT_EQ(arrived(1), arrived(1));
  EXPECT_NE(arrived(1), arrived(2));
}

TEST(MavlinkLink, DownlinkFramesCarryTheTimeOfTheirLastStopBit) {
  Bench bench;
  bench.mcu_sends(bench.heartbeat());
  ASSERT_EQ(bench.frames.size(), 1u);
  EXPECT_EQ(bench.frames[0], bench.queue.now());
  EXPECT_TRUE(bench.findings.empty());
}

TEST(MavlinkLink, BytesOutsideOfFramesAreOneFinding) {
  Bench bench;
  bench.mcu_sends({'b', 'o', 'o', 't', '\n'});
  bench.mcu_sends(bench.heartbeat());
  EXPECT_EQ(bench.frames.size(), 1u);
  ASSERT_EQ(bench.findings.size(), 1u);
  EXPECT_NE(bench.findings[0].find("outside"), std::string::npos);
}

TEST(MavlinkLink, FirstFlightsTrafficFitsAndTwiceAsMuchOverruns) {
  const auto overruns = [](int share) {
    Bench bench;
    // 40 Hz pose (44 bytes), 10 Hz set-point (65) up; about 2.1 kB/s down, as issue "First flight".
    for (int ms = 0; ms < 5000; ms += 25) {
      for (int i = 0; i < share; ++i)
        bench.link.send_frame(std::vector<std::uint8_t>(44), ms * 1'000'000LL);
    }
    for (int ms = 0; ms < 5000; ms += 100) {
      for (int i = 0; i < share; ++i)
        bench.link.send_frame(std::vector<std::uint8_t>(65), ms * 1'000'000LL);
    }
    while (bench.queue.now() < 5'000'000'000) {
      for (int i = 0; i < share; ++i) bench.mcu_sends(bench.heartbeat());
      bench.queue.run_until(bench.queue.now() + 10'000'000 - 21 * kByte_ns * share);
    }
    return bench.link.counts().overruns;
  };
  EXPECT_EQ(overruns(1), 0u);
  EXPECT_GT(overruns(2), 0u);
}

TEST(MavlinkLink, AWrongBaudRateIsNamed) {
  Bench bench;
  bench.mcu_sends(bench.heartbeat(), 115200.0);
  EXPECT_TRUE(bench.frames.empty());
  ASSERT_FALSE(bench.findings.empty());
  EXPECT_NE(bench.findings[0].find("115200"), std::string::npos);
}

}  // namespace
}  // namespace whirl::io
