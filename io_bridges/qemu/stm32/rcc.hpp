// RCC, what both parts have in common: oscillators with their start-up times, the clock switch,
// ready interrupts, reset causes, the backup domain, block enables and resets.
//
//   Source    RM0090 chapter 7 (F405), RM0008 chapter 7 (F103)
//   Times     typical values of the datasheets: HSI 2.2 us, PLL 200 us, LSI 30 us, LSE 2 s; HSE as
//             the board says (2 ms)
//   Errors    an oscillator that runs off its frequency takes all that is clocked from it along;
//             limits are judged by what it says it is
//   Findings  limits of the part; a crystal that was given up, or is not there; a core that stays
//             on its reset clock
//   Left out  MCO pins, spread spectrum, I2S clocks (PLLI2S locks, nobody uses it)
#pragma once
#include <array>
#include <string>
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
  Nanoseconds hse_start_ns = 2'000'000;
  double hsi_error = 0.0, hse_error = 0.0;  // 0.01: runs 1 % faster than it says
};

// Where a part keeps what all parts have.
struct RccLayout {
  std::uint32_t cfgr, cir, bdcr, csr;     // CR is at 0
  std::uint32_t first_reset, last_reset;  // the block reset registers
  std::uint32_t cr_writable;
  std::uint32_t power_on_causes;  // CSR flags
  double hsi_Hz, lsi_Hz;
  double max_sysclk_Hz, max_pclk1_Hz, max_pclk2_Hz;
};

// Frequencies as CFGR and PLL settings give them.
struct ClockTree {
  double sysclk_Hz = 0.0;                    // with oscillators that are what they say
  double ahb = 1.0, apb1 = 1.0, apb2 = 1.0;  // divisors
};

class Rcc : public WordBlock, public Clocks {
 public:
  Rcc(const RccSetup& setup, const RccLayout& layout);

  // Clocks
  double hclk_Hz() const override { return hclk_Hz_; }
  double pclk1_Hz() const override { return pclk1_Hz_; }
  double pclk2_Hz() const override { return pclk2_Hz_; }
  double timclk1_Hz() const override { return timclk1_Hz_; }
  double timclk2_Hz() const override { return timclk2_Hz_; }
  double lsi_Hz() const override { return layout_.lsi_Hz; }
  double lse_Hz() const override { return lse_Hz_; }
  double hse_Hz() const override { return hse_Hz_ * (1.0 + hse_error_); }
  double oscillator_error() const override { return error_of(runs_from_hse()); }
  void on_change(std::function<void()> changed) override {
    listeners_.push_back(std::move(changed));
  }
  double sysclk_Hz() const { return sysclk_Hz_; }

  // Gates. The pointer stays valid; a block's clock is on when (*enable & mask) != 0.
  const std::uint32_t* enable_register(std::uint32_t offset) const { return &word(offset); }
  void on_block_reset(std::uint32_t offset, std::uint32_t mask, std::function<void()> reset);

  // Backup domain: RTC's clock and write protection (PWR_CR.DBP).
  double rtc_Hz() const;  // 0 while RTCEN is off or its source does not run
  void set_backup_writable(std::function<bool()> writable) { backup_writable_ = writable; }
  void on_backup_reset(std::function<void()> reset) { backup_reset_ = std::move(reset); }

  void reset() override;                // registers as after a system reset
  void system_reset(ResetCause cause);  // reset() and the cause in CSR
  void set_vdd(double volts) { vdd_V_ = volts; }
  void fail_hse();  // the crystal stops; with CSSON: HSI takes over, NMI
  void on_nmi(std::function<void(bool)> nmi) { nmi_ = std::move(nmi); }

 protected:
  enum Source : std::uint32_t { hsi = 0, hse = 1, pll = 2 };

  virtual void set_reset_values() = 0;
  virtual ClockTree clock_tree() const = 0;
  virtual bool pll_from_hse() const = 0;
  virtual double rtc_from_hse_Hz() const = 0;
  virtual bool pll_can_lock() { return true; }  // asked as PLLON is set; findings go here
  virtual void write_other(std::uint32_t offset, std::uint32_t value) = 0;

  std::uint32_t& word(std::uint32_t offset) { return words_[offset / 4]; }
  const std::uint32_t& word(std::uint32_t offset) const { return words_[offset / 4]; }
  std::uint32_t sws() const { return (word(layout_.cfgr) >> 2) & 3; }
  bool pll_on() const { return (word(0) & (1u << 24)) != 0; }
  void report_once(std::uint32_t bit, const std::string& what);

  const RccLayout layout_;
  double error_of(bool crystal) const { return crystal ? hse_error_ : hsi_error_; }

  const double hse_Hz_, lse_Hz_;
  const Nanoseconds hse_start_ns_;
  const double hsi_error_, hse_error_;

 private:
  struct ResetLine {
    std::uint32_t offset, mask;
    std::function<void()> reset;
  };

  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
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
  bool runs_from_hse() const { return sws() == hse || (sws() == pll && pll_from_hse()); }
  void watch_crystal(std::uint32_t before, std::uint32_t after);
  void report_unused_crystal();
  void report_reset_clock();

  io::EventQueue& events_;
  InterruptLines& interrupts_;
  io::FindingSink finding_;
  double vdd_V_ = 3.3;
  std::array<std::uint32_t, 0x90 / 4> words_{};
  io::Event hsi_ready_, hse_ready_, pll_ready_, plli2s_ready_, lsi_ready_, lse_ready_;
  io::Event crystal_unused_, still_reset_clock_;  // moments to look again
  std::vector<ResetLine> reset_lines_;
  std::vector<std::function<void()>> listeners_;
  std::function<bool()> backup_writable_;
  std::function<void()> backup_reset_;
  std::function<void(bool)> nmi_;
  double sysclk_Hz_ = 0, hclk_Hz_ = 0, pclk1_Hz_ = 0, pclk2_Hz_ = 0;
  double timclk1_Hz_ = 0, timclk2_Hz_ = 0;
  std::uint32_t reported_ = 0;
};

// Divisors of HPRE and PPRE, the same on both parts.
double ahb_divisor(std::uint32_t hpre);
double apb_divisor(std::uint32_t ppre);

}  // namespace whirl::stm32
