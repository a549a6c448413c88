// Golden frames, packed by hand from the description that three decoders share.
#include "io_bridges/protocols/sbus.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <string>

namespace whirl::io {
namespace {

std::string hex(const SbusFrame& frame) {
  std::string text;
  for (const std::uint8_t byte : encode(frame)) {
    constexpr const char* kDigits = "0123456789ABCDEF";
    text += {kDigits[byte >> 4], kDigits[byte & 15]};
  }
  return text;
}

TEST(Sbus, GoldenFrames) {
  SbusFrame frame;
  frame.channels.fill(992);
  EXPECT_EQ(hex(frame), "0FE0031FF8C0073EF0810F7CE0031FF8C0073EF0810F7C0000");
  frame.channels.fill(1024);
  EXPECT_EQ(hex(frame), "0F000420000108400002108000042000010840000210800000");
  std::iota(frame.channels.begin(), frame.channels.end(), std::uint16_t{0});
  EXPECT_EQ(hex(frame), "0F000880000640800218E0000848800216C0800638E0010000");
  frame.channels = {172,  256,  384,  512,  640,  768,  896,  992,
                    1024, 1152, 1280, 1408, 1536, 1664, 1792, 1811};
  EXPECT_EQ(hex(frame), "0FAC00086000042880010E7C00042440010B6040037CE20000");
  frame.channels.fill(172);
  frame.channels[0] = frame.channels[1] = frame.channels[3] = 992;
  frame.flags = kSbusFrameLost | kSbusFailsafe;
  EXPECT_EQ(hex(frame), "0FE0031F2BC0C70A56B08215AC60052B58C10A56B082150C00");
}

TEST(Sbus, TravelIsLinearBetweenTheEndsAndStaysWithinElevenBits) {
  EXPECT_EQ(sbus_of_travel(-1.0), 172);
  EXPECT_EQ(sbus_of_travel(0.0), 992);
  EXPECT_EQ(sbus_of_travel(1.0), 1811);
  EXPECT_EQ(sbus_of_travel(2.0), 2047);
  EXPECT_EQ(sbus_of_travel(-2.0), 0);
}

}  // namespace
}  // namespace whirl::io
