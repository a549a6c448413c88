// The decoder of the ESC's serial line against a frame that another program packed.
#include "io_bridges/protocols/esc_stream.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io_bridges/protocols/crc.hpp"

namespace whirl::io {
namespace {

// Packed by Python: struct.pack('<BBI14fBBBB', 1, 0xA5, 0x12345678, 16.25, 1.5, 0.25, 1.25, 5, 0.4375,
// 418.5, 420, -12.5, 21.75, 3e-7, 1.6e-5, 2.75, 0.0625, 0, 4, 0x41, 5) between A5 5A and its CRC.
const std::vector<std::uint8_t> kGolden = {
    0xA5, 0x5A, 0x01, 0xA5, 0x78, 0x56, 0x34, 0x12, 0x00, 0x00, 0x82, 0x41, 0x00, 0x00,
    0xC0, 0x3F, 0x00, 0x00, 0x80, 0x3E, 0x00, 0x00, 0xA0, 0x3F, 0x00, 0x00, 0xA0, 0x40,
    0x00, 0x00, 0xE0, 0x3E, 0x00, 0x40, 0xD1, 0x43, 0x00, 0x00, 0xD2, 0x43, 0x00, 0x00,
    0x48, 0xC1, 0x00, 0x00, 0xAE, 0x41, 0xB0, 0x0F, 0xA1, 0x34, 0xBD, 0x37, 0x86, 0x37,
    0x00, 0x00, 0x30, 0x40, 0x00, 0x00, 0x80, 0x3D, 0x00, 0x04, 0x41, 0x05, 0xB4, 0x2E};

std::vector<std::uint8_t> frame(std::uint8_t sequence) {
  std::vector<std::uint8_t> bytes = kGolden;
  bytes[3] = sequence;
  const std::uint16_t crc = crc16(std::span(bytes).subspan(2, 66));
  bytes[68] = crc & 0xFF;
  bytes[69] = crc >> 8;
  return bytes;
}

struct Bench {
  Bench() {
    decoder.on_sample([this](const EscSample& s) { samples.push_back(s); });
    decoder.on_line([this](const std::string& line) { lines.push_back(line); });
  }
  void decode(const std::vector<std::uint8_t>& bytes) { decoder.decode(bytes); }
  void decode(const std::string& text) {
    decoder.decode(std::vector<std::uint8_t>(text.begin(), text.end()));
  }

  EscStreamDecoder decoder;
  std::vector<EscSample> samples;
  std::vector<std::string> lines;
};

TEST(EscStream, ReadsTheGoldenFrame) {
  Bench b;
  b.decode(kGolden);
  ASSERT_EQ(b.samples.size(), 1u);
  const EscSample& s = b.samples[0];
  EXPECT_EQ(s.sequence, 0xA5);
  EXPECT_EQ(s.tick, 0x12345678u);
  EXPECT_EQ(s.bus_voltage_V, 16.25f);
  EXPECT_EQ(s.raw_current_A, 1.5f);
  EXPECT_EQ(s.zero_current_A, 0.25f);
  EXPECT_EQ(s.bus_current_A, 1.25f);
  EXPECT_EQ(s.winding_current_A, 5.0f);
  EXPECT_EQ(s.duty, 0.4375f);
  EXPECT_EQ(s.speed_radps, 418.5f);
  EXPECT_EQ(s.wanted_speed_radps, 420.0f);
  EXPECT_EQ(s.acceleration_radps2, -12.5f);
  EXPECT_EQ(s.power_W, 21.75f);
  EXPECT_EQ(s.CP, 3e-7f);
  EXPECT_EQ(s.CT, 1.6e-5f);
  EXPECT_EQ(s.thrust_N, 2.75f);
  EXPECT_EQ(s.inflow_ratio, 0.0625f);
  EXPECT_EQ(s.solver, EscSolver::converged);
  EXPECT_EQ(s.iterations, 4);
  EXPECT_EQ(s.flags, 0x41);
  EXPECT_EQ(s.mode, 5);
}

TEST(EscStream, TextBetweenFramesComesAsLinesHoweverItIsCut) {
  std::vector<std::uint8_t> all;
  const auto add = [&all](const auto& bytes) { all.insert(all.end(), bytes.begin(), bytes.end()); };
  add(frame(1));
  add(std::string("kt 1.00500002e-2\r\n"));
  add(frame(2));
  add(frame(3));
  add(std::string("ok\r\n"));
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{64}, all.size()}) {
    Bench b;
    for (std::size_t i = 0; i < all.size(); i += piece) {
      b.decoder.decode(std::span(all).subspan(i, std::min(piece, all.size() - i)));
    }
    EXPECT_EQ(b.lines, (std::vector<std::string>{"kt 1.00500002e-2", "ok"}));
    EXPECT_EQ(b.samples.size(), 3u);
    EXPECT_EQ(b.decoder.counts().lost_frames, 0u);
    EXPECT_EQ(b.decoder.counts().bad_crc, 0u);
  }
}

TEST(EscStream, FindsTheFrameBehindATornOneWhereverItWasTorn) {
  for (std::size_t lost = 0; lost < EscStreamDecoder::kFrameSize; ++lost) {
    Bench b;
    b.decode(frame(7));
    std::vector<std::uint8_t> torn = frame(8);
    torn.erase(torn.begin() + static_cast<std::ptrdiff_t>(lost));
    b.decode(torn);
    b.decode(frame(9));
    b.decode(frame(10));
    b.decode("ok\r\n");
    ASSERT_EQ(b.samples.size(), 3u) << lost;
    EXPECT_EQ(b.samples[1].sequence, 9) << lost;
    EXPECT_EQ(b.decoder.counts().lost_frames, 1u) << lost;
    EXPECT_EQ(b.lines, std::vector<std::string>{"ok"}) << lost;
  }
}

TEST(EscStream, AnyFlippedBitIsRefusedAndCounted) {
  for (std::size_t bit = 8 * 2; bit < 8 * EscStreamDecoder::kFrameSize; ++bit) {
    Bench b;
    std::vector<std::uint8_t> bytes = kGolden;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    b.decode(bytes);
    EXPECT_TRUE(b.samples.empty()) << bit;
    EXPECT_GE(b.decoder.counts().bad_crc, 1u) << bit;
  }
}

TEST(EscStream, MissingFramesAreCountedBySequenceAcrossItsWrap) {
  Bench b;
  b.decode(frame(254));
  b.decode(frame(255));
  b.decode(frame(0));
  EXPECT_EQ(b.decoder.counts().lost_frames, 0u);
  b.decode(frame(5));
  EXPECT_EQ(b.decoder.counts().lost_frames, 4u);
  EXPECT_EQ(b.decoder.counts().frames, 4u);
}

TEST(EscStream, ALineWithAForeignByteIsDropped) {
  Bench b;
  b.decode(
      std::string("st\x07"
                  "atus\r\nok\r\n"));
  EXPECT_EQ(b.lines, std::vector<std::string>{"ok"});
  EXPECT_EQ(b.decoder.counts().dropped_lines, 1u);
}

}  // namespace
}  // namespace whirl::io
