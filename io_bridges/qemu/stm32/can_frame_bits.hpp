// How long a CAN frame is on the wire: its bits with CRC and stuffing, from start of frame to the
// end of the interframe space (ISO 11898-1).
#pragma once
#include <cstdint>
#include <vector>

#include "io_bridges/devices/bus.hpp"

namespace whirl::stm32 {

inline int can_frame_bits(const io::CanFrame& frame) {
  std::vector<bool> bits;
  const auto put = [&bits](std::uint32_t value, int count) {
    for (int i = count - 1; i >= 0; --i) bits.push_back(((value >> i) & 1) != 0);
  };
  put(0, 1);  // start of frame
  if (frame.extended) {
    put(frame.id >> 18, 11);
    put(3, 2);  // SRR, IDE
    put(frame.id & 0x3FFFF, 18);
    put(frame.remote ? 1 : 0, 1);
    put(0, 2);  // r1, r0
  } else {
    put(frame.id & 0x7FF, 11);
    put(frame.remote ? 1 : 0, 1);
    put(0, 2);  // IDE, r0
  }
  put(frame.length, 4);
  for (int i = 0; !frame.remote && i < frame.length; ++i) put(frame.data[i], 8);
  std::uint32_t crc = 0;
  for (const bool b : bits) {
    const bool invert = b != (((crc >> 14) & 1) != 0);
    crc = (crc << 1 & 0x7FFF) ^ (invert ? 0x4599u : 0);
  }
  put(crc, 15);
  int stuffed = 0, run = 0;
  bool last = true;  // recessive before the frame, but it does not count into a run
  for (const bool b : bits) {
    run = b == last ? run + 1 : 1;
    last = b;
    if (run == 5) {
      ++stuffed;
      run = 1;
      last = !b;
    }
  }
  // CRC delimiter, acknowledge and its delimiter, seven of end of frame, three of interframe space.
  return static_cast<int>(bits.size()) + stuffed + 1 + 2 + 7 + 3;
}

}  // namespace whirl::stm32
