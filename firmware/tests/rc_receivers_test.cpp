// Edges as measured of receivers, and SBUS frames packed by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <numeric>
#include <string>
#include <vector>

#include "firmware/drivers/cppm_receiver.hpp"
#include "firmware/drivers/sbus_receiver.hpp"

namespace fw {
namespace {

struct CppmBench {
  CppmReceiver receiver;
  std::uint32_t now_us = 0xFFFF'8000;  // wraps in the third frame
  int frames = 0;

  void frame(const std::vector<std::uint32_t>& channels_us, std::uint32_t period_us = 22'500) {
    const std::uint32_t start_us = now_us;
    edge();
    for (const std::uint32_t width_us : channels_us) now_us += width_us, edge();
    now_us = start_us + period_us;
  }
  void frames_of(int n, const std::vector<std::uint32_t>& channels_us) {
    for (int k = 0; k < n; ++k) frame(channels_us);
  }
  void edge() { frames += receiver.edge(now_us) ? 1 : 0; }
  std::vector<int> channels() const {
    const CppmFrame& f = receiver.frame();
    return {f.channels_us.begin(), f.channels_us.begin() + f.count};
  }
};

const std::vector<std::uint32_t> kEight = {1000, 1500, 2000, 1200, 1500, 1500, 1500, 1800};

TEST(CppmReceiver, LocksAfterFourFramesAndReadsEightChannels) {
  CppmBench bench;
  bench.frames_of(4, kEight);
  EXPECT_EQ(bench.frames, 0);  // the fourth ends with the gap behind it
  EXPECT_EQ(bench.receiver.status(bench.now_us), Status::no_answer);
  bench.frame(kEight);
  EXPECT_EQ(bench.frames, 1);
  EXPECT_EQ(bench.channels(), (std::vector<int>{1000, 1500, 2000, 1200, 1500, 1500, 1500, 1800}));
  EXPECT_EQ(bench.receiver.status(bench.now_us), Status::ok);
}

TEST(CppmReceiver, AMissingPulseCostsItsFrameAlone) {
  for (const std::vector<std::uint32_t>& merged :
       {std::vector<std::uint32_t>{1000, 1500, 3200, 1500, 1500, 1500, 1800},  // as long as a gap
        std::vector<std::uint32_t>{1000, 1500, 2000, 2650, 1500, 1500, 1800},
        std::vector<std::uint32_t>{1000, 1500, 2000, 1200, 1500, 1500, 3300}}) {
    CppmBench bench;
    bench.frames_of(10, kEight);
    bench.frame(merged);
    bench.frames = 0;
    bench.frame(kEight);
    EXPECT_EQ(bench.frames, 0);
    EXPECT_EQ(bench.channels(), (std::vector<int>{1000, 1500, 2000, 1200, 1500, 1500, 1500, 1800}));
    EXPECT_EQ(bench.receiver.status(bench.now_us), Status::ok);
    bench.frame(kEight);
    EXPECT_EQ(bench.frames, 1);
  }
}

TEST(CppmReceiver, AGlitchWithinAChannelIsNoChannel) {
  CppmBench bench;
  bench.frames_of(10, kEight);
  bench.frames = 0;
  bench.frame({1000, 700, 800, 2000, 1200, 1500, 1500, 1500, 1800});
  bench.frame(kEight);
  EXPECT_EQ(bench.frames, 1);
  EXPECT_EQ(bench.receiver.bad_intervals(), 1u);
  EXPECT_EQ(bench.channels()[1], 1500);
}

TEST(CppmReceiver, AnotherNumberOfChannelsHasToRepeat) {
  CppmBench bench;
  bench.frames_of(10, kEight);
  const std::vector<std::uint32_t> seven(kEight.begin(), kEight.end() - 1);
  bench.frames_of(4, seven);  // of which three have ended
  EXPECT_EQ(bench.channels().size(), 8u);
  bench.frame(kEight);
  EXPECT_EQ(bench.channels().size(), 7u);
  bench.frames_of(4, kEight);
  EXPECT_EQ(bench.channels().size(), 8u);
}

TEST(CppmReceiver, IsLostAfterATenthOfASecond) {
  CppmBench bench;
  bench.frames_of(10, kEight);
  const std::uint32_t heard_us = bench.receiver.frame().received_us;
  EXPECT_EQ(bench.receiver.status(heard_us + 99'999), Status::ok);
  EXPECT_EQ(bench.receiver.status(heard_us + 100'000), Status::no_answer);
  bench.now_us += 1'000'000;
  bench.frame(kEight);
  EXPECT_EQ(bench.channels().size(), 8u);
}

TEST(CppmReceiver, LimitsOfAChannelAndTooFewOfThem) {
  for (const auto& [width_us, good] :
       {std::pair{799u, false}, {800u, true}, {2200u, true}, {2201u, false}}) {
    CppmBench bench;
    bench.frames_of(10, {width_us, 1500, 1500, 1500, 1500, 1500});
    EXPECT_EQ(bench.frames > 0, good) << width_us;
  }
  CppmBench four;
  four.frames_of(10, {1500, 1500, 1500, 1500});
  EXPECT_EQ(four.frames, 0);
}

std::vector<std::uint8_t> bytes_of(const std::string& hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

const std::string kCentred = "0FE0031FF8C0073EF0810F7CE0031FF8C0073EF0810F7C0000";
const std::string kRamp = "0FAC00086000042880010E7C00042440010B6040037CE20000";
const std::string kLost = "0FE0031F2BC0C70A56B08215AC60052B58C10A56B082150C00";

struct SbusBench {
  SbusReceiver receiver;
  std::uint32_t now_us = 0xFFFF'F000;
  int frames = 0;

  void frame(const std::string& hex, int error_at = -1) {
    int at = 0;
    for (const std::uint8_t byte : bytes_of(hex)) {
      now_us += 120;
      frames += receiver.push(byte, now_us, at++ == error_at) ? 1 : 0;
    }
    now_us += 11'000;
  }
};

TEST(SbusReceiver, GoldenFrames) {
  SbusBench bench;
  bench.now_us += 2000;
  bench.frame(kCentred);
  ASSERT_EQ(bench.frames, 1);
  for (const std::uint16_t channel : bench.receiver.frame().channels) EXPECT_EQ(channel, 992);
  bench.frame(kRamp);
  EXPECT_EQ(bench.receiver.frame().channels,
            (std::array<std::uint16_t, 16>{172, 256, 384, 512, 640, 768, 896, 992, 1024, 1152, 1280,
                                           1408, 1536, 1664, 1792, 1811}));
  EXPECT_FALSE(bench.receiver.frame().failsafe);
  bench.frame(kLost);
  EXPECT_TRUE(bench.receiver.frame().frame_lost);
  EXPECT_TRUE(bench.receiver.frame().failsafe);
  EXPECT_EQ(bench.receiver.frame().channels[2], 172);
}

// Betaflight's scale: 173 is 988 us, 993 1500.6, 1812 2012.
TEST(SbusReceiver, PulsesAsBetaflightScalesThem) {
  SbusFrame frame;
  frame.channels = {173, 993, 1812};
  EXPECT_EQ(frame.pulse_us(0), 988u);
  EXPECT_EQ(frame.pulse_us(1), 1501u);
  EXPECT_EQ(frame.pulse_us(2), 2013u);  // 2012.5
}

// Betaflight and PX4 flag both: frame lost 0x04, failsafe 0x08. Either says that the sticks are not told.
TEST(SbusReceiver, AFrameWithEitherFlagIsNoNewsOfTheSticks) {
  for (const auto& [flags, news] :
       {std::pair{"00", true}, {"04", false}, {"08", false}, {"0C", false}, {"03", true}}) {
    SbusBench bench;
    bench.now_us += 2000;
    bench.frame(kCentred.substr(0, 46) + flags + "00");
    ASSERT_EQ(bench.frames, 1);
    EXPECT_EQ(bench.receiver.frame().is_news(), news) << flags;
    EXPECT_EQ(bench.receiver.frame().pulses_us()[15], 1500u);
  }
}

TEST(SbusReceiver, ItWaitsForAPauseBeforeItsFirstFrame) {
  SbusBench bench;
  bench.now_us = 0;
  const auto bytes = bytes_of(kCentred + kCentred);
  for (std::size_t i = 3; i < bytes.size(); ++i) {
    bench.frames += bench.receiver.push(bytes[i], bench.now_us += 120) ? 1 : 0;
  }
  EXPECT_EQ(bench.frames, 0);
  bench.now_us += 2000;
  bench.frame(kCentred);
  EXPECT_EQ(bench.frames, 1);
}

TEST(SbusReceiver, AByteWithAnErrorSpoilsItsFrameAlone) {
  for (int at = 0; at < 25; ++at) {
    SbusBench bench;
    bench.now_us += 2000;
    bench.frame(kRamp, at);
    EXPECT_EQ(bench.frames, 0) << at;
    bench.frame(kCentred);
    EXPECT_EQ(bench.frames, 1) << at;
    EXPECT_EQ(bench.receiver.bad_frames(), 1u);
  }
}

TEST(SbusReceiver, AFrameThatIsCutIsNotCompletedByTheNext) {
  SbusBench bench;
  bench.now_us += 2000;
  bench.frame(kRamp.substr(0, 30));
  bench.frame(kCentred);
  EXPECT_EQ(bench.frames, 1);
  EXPECT_EQ(bench.receiver.frame().channels[0], 992);
}

TEST(SbusReceiver, IsLostAfterATenthOfASecond) {
  SbusBench bench;
  EXPECT_EQ(bench.receiver.status(0), Status::no_answer);
  bench.now_us += 2000;
  bench.frame(kCentred);
  const std::uint32_t heard_us = bench.receiver.frame().received_us;
  EXPECT_EQ(bench.receiver.status(heard_us + 99'999), Status::ok);
  EXPECT_EQ(bench.receiver.status(heard_us + 100'000), Status::no_answer);
}

}  // namespace
}  // namespace fw
