// The CRC unit of F405 and F103: CRC-32, polynomial 0x04C11DB7, start 0xFFFFFFFF, whole words, most
// significant bit first, no reflection. One instance serves any number of words at once: four AHB
// clocks per word pass within the bus access.
#pragma once
#include "io_bridges/qemu/stm32/peripheral.hpp"

namespace whirl::stm32 {

class Crc : public Peripheral {
 public:
  const char* name() const override { return "CRC"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;

 private:
  std::uint32_t crc_ = 0xFFFFFFFF;
  std::uint32_t independent_ = 0;
};

}  // namespace whirl::stm32
