// The flash cells, as the FLASH interface block acts on them. The plug-in implements it over guest
// memory (and throws away code that was translated from there); tests over a vector.
#pragma once
#include <cstdint>

namespace whirl::stm32 {

class FlashArray {
 public:
  virtual ~FlashArray() = default;
  // Addresses are the guest's (0x08000000 ..). Program clears bits only: cells become old & value;
  // size is 1, 2, 4 or 8 bytes, address aligned to it.
  virtual void program(std::uint32_t address, std::uint64_t value, unsigned size) = 0;
  virtual std::uint64_t read(std::uint32_t address, unsigned size) = 0;
  virtual void erase(std::uint32_t address, std::uint32_t bytes) = 0;  // to 0xFF
  // While locked, CPU writes into flash must come to the FLASH block (see FlashInterface::store)
  // instead of memory: the plug-in maps the array read-only and forwards them.
};

}  // namespace whirl::stm32
