// One frame of the binary stream: what the control core knew at the end of one tick.
//
//   Layout  A5 5A, version, sequence, tick (u32), 14 floats, solver status, iterations, flags, mode,
//           CRC-16 (poly 0x1021 reflected, init 0xFFFF, over all between sync and CRC); little endian
//   Text    the same line carries answers in ASCII: no frame begins with a byte of text
#pragma once
#include <array>
#include <cstdint>

namespace fw::esc {

struct StreamSample {
  std::uint32_t tick = 0;  // control ticks since power-up
  float bus_voltage_V = 0.0f;
  float raw_current_A = 0.0f;   // of the bus, mean of the tick, as the shunt's amplifier gives it
  float zero_current_A = 0.0f;  // what of it was found at rest
  float bus_current_A = 0.0f;   // calibrated, mean of the tick
  float winding_current_A = 0.0f;
  float duty = 0.0f;
  float speed_radps = 0.0f;
  float wanted_speed_radps = 0.0f;
  float acceleration_radps2 = 0.0f;
  float power_W = 0.0f;  // aerodynamic
  float CP = 0.0f, CT = 0.0f;
  float thrust_N = 0.0f;
  float inflow_ratio = 0.0f;  // of the stream; means something if the solver has converged
  std::uint8_t solver_status = 0, iterations = 0, flags = 0, mode = 0;
};

inline constexpr std::size_t kStreamFrameSize = 70;
inline constexpr std::uint8_t kStreamVersion = 1;
using StreamFrame = std::array<char, kStreamFrameSize>;

StreamFrame pack(const StreamSample& sample, std::uint8_t sequence);

}  // namespace fw::esc
