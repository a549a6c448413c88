// FLASH interface of the STM32F405: latency, keys, sector erase, programming, option bytes.
//
//   Source    RM0090 chapter 3; busy times from the STM32F405 datasheet (typical): word 16 us,
//             sectors by size and PSIZE 250 ms to 2 s, mass erase 8 to 16 s
//   Errors    PGSERR no PG, PGPERR size other than PSIZE, PGAERR not aligned, WRPERR protected
//   Findings  too few wait states for HCLK (at 2.7 to 3.6 V)
//   Left out  the core stalls on a fetch while BSY on the part; here it runs on. RDP is stored
#pragma once
#include "io_bridges/qemu/cycles/flash_timing.hpp"
#include "io_bridges/qemu/stm32/flash_array.hpp"
#include "io_bridges/qemu/stm32/flash_keys.hpp"
#include "io_bridges/qemu/stm32/word_block.hpp"

namespace whirl::stm32 {

class FlashF4 final : public WordBlock {
 public:
  FlashF4(Chip chip, FlashArray& array, std::uint32_t bytes);

  // The CPU (or DMA) stored into the array's addresses.
  void store(std::uint32_t address, unsigned size, std::uint32_t value);
  void reset() override;
  cycles::FlashTiming timing() const;
  void on_timing_change(std::function<void()> changed) { timing_changed_ = std::move(changed); }

 private:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  void write_cr(std::uint32_t value);
  void write_optcr(std::uint32_t value);
  void erase();
  bool protected_sector(unsigned sector) const;
  void busy(Nanoseconds duration);
  void fail(std::uint32_t error);
  void done();
  void update();
  void set_acr(std::uint32_t value);
  void check_latency();

  Chip chip_;
  FlashArray& array_;
  std::uint32_t bytes_;
  io::Event done_;
  std::uint32_t acr_ = 0, sr_ = 0, cr_ = 0x80000000, optcr_ = 0x0FFFAAED;
  FlashKeys keys_ = kProgramKeys, option_keys_{0x08192A3B, 0x4C5D6E7F};
  std::function<void()> timing_changed_;
  bool latency_reported_ = false;
};

}  // namespace whirl::stm32
