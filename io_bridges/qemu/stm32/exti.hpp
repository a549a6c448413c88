// EXTI and the part of SYSCFG (F405) that selects its ports.
//
//   Source   RM0090 chapters 9.2 (SYSCFG), 12.2 (EXTI)
//   Lines    0-15 pins of the port that EXTICR selects, 16 PVD, 17 RTC alarm, 18 OTG FS wake-up,
//            19 Ethernet, 20 OTG HS, 21 tamper, 22 RTC wake-up: set_line()
//   Pending  follows the edge detector whatever IMR says; SWIER acts on unmasked lines only
//   Events   (EMR) reach on_event(); nobody wakes a WFE from there yet
#pragma once
#include <array>
#include <cstdint>

#include "io_bridges/qemu/stm32/word_block.hpp"

namespace whirl::stm32 {

class Exti final : public WordBlock {
 public:
  static constexpr int kLines = 23;

  // `irq_of_line` maps each line to its interrupt; several lines share one.
  Exti(Chip chip, const std::array<int, kLines>& irq_of_line);

  void pin_edge(char port, int pin, bool level);      // from GPIO
  void set_line(int line, bool level);                // from inside the part
  void select_port(int line, char port, bool level);  // from EXTICR
  void on_event(std::function<void(int line)> event) { event_ = std::move(event); }  // EMR: WFE

  void reset() override;

 private:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  void update_irqs(std::uint32_t lines);

  Chip chip_;
  std::array<int, kLines> irq_of_line_;
  std::array<char, 16> port_;
  std::function<void(int)> event_;
  std::uint32_t imr_ = 0, emr_ = 0, rtsr_ = 0, ftsr_ = 0, swier_ = 0, pr_ = 0;
  std::uint32_t level_ = 0;
};

// The four EXTICR registers sit in SYSCFG at 0x08 (F405) and in AFIO at 0x08 (F103).
class ExtiPorts {
 public:
  using Level = std::function<bool(char port, int pin)>;

  ExtiPorts(Exti& exti, Level level) : exti_(exti), level_(std::move(level)) {}
  void reset();
  std::uint32_t read(int index) const { return exticr_[static_cast<std::size_t>(index)]; }
  void write(int index, std::uint32_t value);

 private:
  Exti& exti_;
  Level level_;
  std::array<std::uint32_t, 4> exticr_{};
};

class Syscfg final : public WordBlock {
 public:
  Syscfg(Exti& exti, ExtiPorts::Level level)
      : WordBlock("SYSCFG"), ports_(exti, std::move(level)) {}
  // MEM_MODE was changed: what is to appear at address 0 (0 flash, 1 system flash, 3 SRAM).
  void on_memory_remap(std::function<void(std::uint32_t)> remap) { remap_ = std::move(remap); }

  void reset() override;

 private:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;

  ExtiPorts ports_;
  std::function<void(std::uint32_t)> remap_;
  std::uint32_t memrmp_ = 0, pmc_ = 0, cmpcr_ = 0;
};

}  // namespace whirl::stm32
