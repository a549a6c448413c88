// The two flash sectors of 16 KiB that the image leaves free (stm32f405rg.ld): words in, words out.
//
//   Source  RM0090 3.6 (erase and program), 3.5.2 (data cache); 32 bits at a time need 2.7 to 3.6 V
//   Time    a word 16 us, up to 100 us; an erase 0.25 s, up to 0.5 s. The part has one bank: the core
//           stalls at its next fetch until it is done, interrupts too
//   Errors  no_answer: still busy after a second; bad_data: the interface refused (its flags are
//           cleared)
#pragma once
#include <cstdint>

#include "firmware/status.hpp"

namespace fw::hal {

class ParameterSectors {
 public:
  static constexpr std::uint32_t kWords = 16 * 1024 / 4;  // of each

  std::uint32_t read(unsigned sector, std::uint32_t word) const;
  Status program(unsigned sector, std::uint32_t word, std::uint32_t value);
  Status erase(unsigned sector);  // longer than the watchdog waits: only before it is started
};

extern ParameterSectors parameter_sectors;

}  // namespace fw::hal
