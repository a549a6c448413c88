// The flash interface as its access control register (FLASH_ACR) says now.
#pragma once
#include <cstdint>

namespace whirl::cycles {

struct FlashTiming {
  int wait_states = 0;
  std::uint32_t line_bytes = 16;
  bool prefetch = false;
  bool line_cache = false;  // ICEN
  bool data_cache = false;  // DCEN
  bool operator==(const FlashTiming&) const = default;
};

}  // namespace whirl::cycles
