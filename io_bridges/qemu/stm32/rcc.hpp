// RCC of the STM32F405: oscillators, PLL, prescalers, block enables and resets, reset causes.
//
//   Source    RM0090 chapter 7; start-up times from the STM32F405 datasheet (typical): HSE 2 ms,
//             HSI 2.2 us, PLL 200 us, LSI 30 us, LSE 2 s
//   Findings  PLL input outside 1..2 MHz, VCO outside 100..432 MHz, SYSCLK, PCLK1 or PCLK2 above
//             168, 42, 84 MHz: once each
//   Left out  MCO pins, spread spectrum, I2S clocks (PLLI2S locks, nobody uses it)
#pragma once
#include <array>
#include <vector>

#include "io_bridges/qemu/stm32/reset_cause.hpp"
#include "io_bridges/qemu/stm32/word_block.hpp"

namespace whirl::stm32 {

// What RCC needs from the board and the rest of the chip. Unlike other blocks it is given no
// Clocks: it is them.
struct RccSetup {
  io::EventQueue& events;
  InterruptLines& interrupts;
  io::FindingSink finding;
  double hse_Hz = 0.0;  // 0: no crystal fitted, HSE never becomes ready
  double lse_Hz = 0.0;
};

class Rcc final : public WordBlock, public Clocks {
 public:
  explicit Rcc(const RccSetup& setup);

  // Clocks
  double hclk_Hz() const override { return hclk_Hz_; }
  double pclk1_Hz() const override { return pclk1_Hz_; }
  double pclk2_Hz() const override { return pclk2_Hz_; }
  double timclk1_Hz() const override { return timclk1_Hz_; }
  double timclk2_Hz() const override { return timclk2_Hz_; }
  double lsi_Hz() const override { return 32'000.0; }
  double lse_Hz() const override { return lse_Hz_; }
  double hse_Hz() const override { return hse_Hz_; }
  void on_change(std::function<void()> changed) override {
    listeners_.push_back(std::move(changed));
  }
  double sysclk_Hz() const { return sysclk_Hz_; }
  double pll48_Hz() const;  // PLLQ output: RNG, SDIO, USB

  // Gates. The pointers stay valid; a block's clock is on when (*enable & mask) != 0.
  const std::uint32_t* enable_register(std::uint32_t offset) const { return &word(offset); }
  void on_block_reset(std::uint32_t offset, std::uint32_t mask, std::function<void()> reset);

  // Backup domain: RTC's clock and write protection (PWR_CR.DBP).
  double rtc_Hz() const;  // 0 while RTCEN is off or its source does not run
  bool rtc_enabled() const;
  void set_backup_writable(std::function<bool()> writable) { backup_writable_ = writable; }
  void on_backup_reset(std::function<void()> reset) { backup_reset_ = std::move(reset); }

  void reset() override;                // registers as after a system reset
  void system_reset(ResetCause cause);  // reset() and the cause in CSR
  void fail_hse();                      // the crystal stops; with CSSON: HSI takes over, NMI
  void on_nmi(std::function<void(bool)> nmi) { nmi_ = std::move(nmi); }

 private:
  struct ResetLine {
    std::uint32_t offset, mask;
    std::function<void()> reset;
  };

  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t& word(std::uint32_t offset) { return words_[offset / 4]; }
  const std::uint32_t& word(std::uint32_t offset) const { return words_[offset / 4]; }

  void write_cr(std::uint32_t value);
  void write_cfgr(std::uint32_t value);
  void write_cir(std::uint32_t value);
  void write_bdcr(std::uint32_t value);
  void write_csr(std::uint32_t value);
  void write_reset_register(std::uint32_t offset, std::uint32_t value);
  void start(io::Event& ready, Nanoseconds delay, std::uint32_t offset, std::uint32_t on_bit,
             std::uint32_t before, std::uint32_t after, bool fitted);
  void became_ready(std::uint32_t offset, std::uint32_t ready_bit, std::uint32_t flag);
  void try_switch();
  void update_clocks();
  void update_irq();
  double pll_vco_Hz() const;
  void check_limits();
  void report_once(std::uint32_t bit, const std::string& what);

  io::EventQueue& events_;
  InterruptLines& interrupts_;
  io::FindingSink finding_;
  double hse_Hz_, lse_Hz_;
  std::array<std::uint32_t, 0x90 / 4> words_{};
  io::Event hsi_ready_, hse_ready_, pll_ready_, plli2s_ready_, lsi_ready_, lse_ready_;
  std::vector<ResetLine> reset_lines_;
  std::vector<std::function<void()>> listeners_;
  std::function<bool()> backup_writable_;
  std::function<void()> backup_reset_;
  std::function<void(bool)> nmi_;
  double sysclk_Hz_ = 0, hclk_Hz_ = 0, pclk1_Hz_ = 0, pclk2_Hz_ = 0;
  double timclk1_Hz_ = 0, timclk2_Hz_ = 0;
  std::uint32_t reported_ = 0;
};

}  // namespace whirl::stm32
