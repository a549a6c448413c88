// What a flight controller once did on an IMU's bus: recorded from a run, to be done again.
//
//   File    text, a line each, in order of time, all in ns since power-up:
//             R TIME                              the part's interrupt line rose
//             T START FIRST_EDGE BYTE TAIL PAIRS  a transfer: chip select fell; from there to the first
//                                                 edge; a byte's length; from the last byte's end to chip
//                                                 select's rise; MOSI and MISO in turn, hexadecimal
//   Source  `whirl export --csv` and test_plans/pod/record.sh
//   Errors  bad_input, with the line
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl::rack {

// The read from ACCEL_XOUT_H on, by which a sample is fetched.
inline constexpr std::uint8_t kBurst = 0xBB;

struct RecordedTransfer {
  std::int64_t start_ns = 0;
  std::int64_t lead_ns = 0, byte_ns = 0, tail_ns = 0;
  std::int64_t ready_ns =
      -1;  // of a burst: the rise that it came after; -1: none since the one before
  std::vector<std::uint8_t> mosi, miso;
};

Result<std::vector<RecordedTransfer>> read_traffic(const std::string& path);

}  // namespace whirl::rack
