// The frame as the image packs it, against the bytes that another program packed.
#include "firmware/esc/image/stream_frame.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fw::esc {
namespace {

// Packed by Python: struct.pack('<BBI14fBBBB', 1, 0xA5, 0x12345678, 16.25, 1.5, 0.25, 1.25, 5, 0.4375,
// 418.5, 420, -12.5, 21.75, 3e-7, 1.6e-5, 2.75, 0.0625, 0, 4, 0x41, 5) between A5 5A and its CRC.
const std::vector<std::uint8_t> kGolden = {
    0xA5, 0x5A, 0x01, 0xA5, 0x78, 0x56, 0x34, 0x12, 0x00, 0x00, 0x82, 0x41, 0x00, 0x00,
    0xC0, 0x3F, 0x00, 0x00, 0x80, 0x3E, 0x00, 0x00, 0xA0, 0x3F, 0x00, 0x00, 0xA0, 0x40,
    0x00, 0x00, 0xE0, 0x3E, 0x00, 0x40, 0xD1, 0x43, 0x00, 0x00, 0xD2, 0x43, 0x00, 0x00,
    0x48, 0xC1, 0x00, 0x00, 0xAE, 0x41, 0xB0, 0x0F, 0xA1, 0x34, 0xBD, 0x37, 0x86, 0x37,
    0x00, 0x00, 0x30, 0x40, 0x00, 0x00, 0x80, 0x3D, 0x00, 0x04, 0x41, 0x05, 0xB4, 0x2E};

TEST(StreamFrame, IsTheGoldenFrame) {
  StreamSample s;
  s.tick = 0x12345678;
  s.bus_voltage_V = 16.25f;
  s.raw_current_A = 1.5f;
  s.zero_current_A = 0.25f;
  s.bus_current_A = 1.25f;
  s.winding_current_A = 5.0f;
  s.duty = 0.4375f;
  s.speed_radps = 418.5f;
  s.wanted_speed_radps = 420.0f;
  s.acceleration_radps2 = -12.5f;
  s.power_W = 21.75f;
  s.CP = 3e-7f;
  s.CT = 1.6e-5f;
  s.thrust_N = 2.75f;
  s.inflow_ratio = 0.0625f;
  s.solver_status = 0;
  s.iterations = 4;
  s.flags = 0x41;
  s.mode = 5;
  const StreamFrame frame = pack(s, 0xA5);
  EXPECT_EQ(std::vector<std::uint8_t>(frame.begin(), frame.end()), kGolden);
}

}  // namespace
}  // namespace fw::esc
