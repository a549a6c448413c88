// FLASH interface of the STM32F103 (medium density): half-word programming, pages of 1 KiB.
//
//   Source    PM0075; times from the STM32F103 datasheet: half-word 52.5 us, page 30 ms, mass 30 ms
//   Errors    PGERR where the half-word is not erased (unless 0 is written), WRPRTERR never: no page
//             is protected here
//   Bus fault a store of another width, or without PG: store() answers false
//   Left out  option bytes (OBR and WRPR read as erased), the stall of fetches while BSY
#pragma once
#include "io_bridges/qemu/cycles/flash_timing.hpp"
#include "io_bridges/qemu/stm32/flash_array.hpp"
#include "io_bridges/qemu/stm32/flash_keys.hpp"
#include "io_bridges/qemu/stm32/word_block.hpp"

namespace whirl::stm32 {

class FlashF1 final : public WordBlock {
 public:
  FlashF1(Chip chip, FlashArray& array, std::uint32_t bytes);

  bool store(std::uint32_t address, unsigned size, std::uint32_t value);
  void reset() override;
  cycles::FlashTiming timing() const;
  void on_timing_change(std::function<void()> changed) { timing_changed_ = std::move(changed); }

 private:
  static constexpr std::uint32_t kPage = 1024, kBase = 0x08000000;

  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  void write_cr(std::uint32_t value);
  void begin();
  void busy(Nanoseconds duration);
  void done();
  void update();
  void set_acr(std::uint32_t value);
  void check_latency();

  Chip chip_;
  FlashArray& array_;
  std::uint32_t bytes_;
  io::Event done_;
  std::uint32_t acr_ = 0x30, sr_ = 0, cr_ = 0x80, ar_ = 0;
  FlashKeys keys_ = kProgramKeys;
  std::function<void()> timing_changed_;
  bool latency_reported_ = false;
};

}  // namespace whirl::stm32
