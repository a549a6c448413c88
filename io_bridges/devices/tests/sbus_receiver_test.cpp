#include <gtest/gtest.h>

#include "io_bridges/devices/sbus.hpp"
#include "io_bridges/devices/uart_sampling.hpp"

namespace whirl::io {
namespace {

struct Bench {
  explicit Bench(const SbusReceiver::Params& params = {}) : receiver(queue, params, &book) {
    receiver.join([this](const UartByte& byte, const UartFormat& f) {
      if (bytes.empty() || queue.now() - last > 1'000'000)
        frames.emplace_back(), at.push_back(queue.now());
      frames.back().push_back(byte.value);
      bytes.push_back(byte.value);
      last = queue.now();
      format = f;
    });
  }
  void run_ms(int ms, bool transmitting = true) {
    for (int k = 0; k < ms; ++k) {
      if (transmitting && k % 20 == 0) receiver.on_sticks(sticks);
      queue.run_until(queue.now() + 1'000'000);
    }
  }
  // Of the last whole frame: bits 22 to 32 of its channels.
  unsigned thrust() const {
    const auto& f = frames[frames.size() - (frames.back().size() == 25 ? 1 : 2)];
    return (f.at(3) >> 6 | f.at(4) << 2 | f.at(5) << 10) & 0x7FF;
  }
  int flags() const {  // of the last whole frame
    return frames[frames.size() - (frames.back().size() == 25 ? 1 : 2)].at(23);
  }

  EventQueue queue;
  FaultBook book;
  SbusReceiver receiver;
  StickPositions sticks{};
  std::vector<std::vector<std::uint8_t>> frames;
  std::vector<std::uint8_t> bytes;
  std::vector<Nanoseconds> at;
  Nanoseconds last = 0;
  UartFormat format;
};

// All sticks centred are 992: the golden frame.
TEST(SbusReceiver, AFrameIsThreeMillisecondsOf8E2At100000Baud) {
  Bench bench;
  bench.run_ms(320);
  EXPECT_EQ(bench.frames.front().size(), 25u);
  const std::vector<std::uint8_t> half = {0xE0, 0x03, 0x1F, 0xF8, 0xC0, 0x07,
                                          0x3E, 0xF0, 0x81, 0x0F, 0x7C};
  std::vector<std::uint8_t> golden = {0x0F};
  golden.insert(golden.end(), half.begin(), half.end());
  golden.insert(golden.end(), half.begin(), half.end());
  golden.insert(golden.end(), {0x00, 0x00});
  EXPECT_EQ(bench.frames[bench.frames.size() - 2], golden);
  EXPECT_EQ(bench.at[0], 200'120'000);  // 120 us a byte
  EXPECT_EQ(bench.at[1] - bench.at[0], 14'000'000);
  EXPECT_EQ(bench.format.parity, 'E');
  EXPECT_EQ(bench.format.stop_bits, 2.0);
  EXPECT_TRUE(bench.format.inverted);
}

TEST(SbusReceiver, AnInverterOnTheBoardTurnsTheLine) {
  SbusReceiver::Params params;
  params.inverter = true;
  Bench bench(params);
  bench.run_ms(220);
  EXPECT_FALSE(bench.format.inverted);
}

TEST(SbusReceiver, FramesAreFlaggedLostAndThenFailsafe) {
  Bench bench;
  bench.run_ms(1000);
  EXPECT_EQ(bench.flags(), 0);
  bench.run_ms(200, false);
  EXPECT_EQ(bench.flags(), 0x04);
  bench.run_ms(500, false);
  EXPECT_EQ(bench.flags(), 0x0C);
  bench.run_ms(100);
  EXPECT_EQ(bench.flags(), 0);
}

TEST(SbusReceiver, BeforeItHearsAnythingItSaysFailsafe) {
  Bench bench;
  bench.run_ms(300, false);
  EXPECT_EQ(bench.flags(), 0x0C);
  EXPECT_EQ(bench.thrust(), 172u);  // its lower stop
}

TEST(SbusReceiver, FailsafeStylesStopOrLowerTheThrust) {
  SbusReceiver::Params params;
  params.link.failsafe = Failsafe::stop;
  Bench stops(params);
  stops.run_ms(1000);
  stops.run_ms(700, false);
  stops.bytes.clear();
  stops.run_ms(300, false);
  EXPECT_TRUE(stops.bytes.empty());
  params.link.failsafe = Failsafe::fixed;
  Bench fixed(params);
  fixed.run_ms(1000);
  fixed.run_ms(700, false);
  EXPECT_EQ(fixed.thrust(), 8u);  // 991.5 - 1.2 x 819.5
}

TEST(SbusReceiver, AGlitchCarriesAnyValuesInAGoodFrame) {
  Bench bench;
  bench.run_ms(500);
  bench.book.add({.number = 1, .kind = FaultKind::rc_glitch, .value = 1.0});
  bench.run_ms(100);
  const auto& a = bench.frames[bench.frames.size() - 2];
  const auto& b = bench.frames[bench.frames.size() - 3];
  EXPECT_EQ(a.size(), 25u);
  EXPECT_EQ(a[0], 0x0F);
  EXPECT_NE(a, b);
}

}  // namespace
}  // namespace whirl::io
