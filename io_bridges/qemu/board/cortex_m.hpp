// Blocks of the core that QEMU lacks or models coarsely: SysTick on the part's own clock tree, the
// cycle counter, the debug identity.
//
//   Source    ARMv7-M ARM: B3.3 SysTick, C1.8 DWT; RM0090 38.16 DBGMCU
//   SysTick   wraps at exact multiples of (RVR + 1) / f from its start: no drift by rounding
//   CYCCNT    counts HCLK's cycles, asleep or not
//   Left out  DWT comparators and profiling counters (read 0), FPB, ITM and TPIU output (swallowed)
#pragma once
#include <cstdint>
#include <functional>

#include "io_bridges/qemu/stm32/peripheral.hpp"

namespace whirl::board {

using io::Nanoseconds;

class SysTick final : public stm32::Peripheral {
 public:
  // `ahead_ns`: of the core's own time before that of events.
  SysTick(io::EventQueue& events, const stm32::Clocks& clocks, std::function<double()> ahead_ns,
          std::function<void()> pend);

  const char* name() const override { return "SysTick"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;
  void clocks_changed();

 private:
  double frequency_Hz() const;
  std::uint32_t current() const;
  void start_from(std::uint32_t value);  // counts down from there, now
  void wrap();
  void schedule();

  io::EventQueue& events_;
  const stm32::Clocks& clocks_;
  std::function<double()> ahead_ns_;
  std::function<void()> pend_;
  io::Event wrap_;
  std::uint32_t control_ = 0, reload_ = 0;
  std::uint32_t frozen_ = 0;  // value while stopped
  bool flag_ = false;
  double anchor_ns_ = 0;        // the count began here
  double to_first_wrap_ = 0.0;  // ticks from the anchor to the first wrap
  std::int64_t wraps_ = 0;      // since the anchor
  double anchor_Hz_ = 0.0;
};

class CycleCounter final : public stm32::Peripheral {
 public:
  explicit CycleCounter(std::function<std::uint64_t()> cycles) : cycles_(std::move(cycles)) {}

  const char* name() const override { return "DWT"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;
  void set_trace_enabled(bool on);  // DEMCR.TRCENA

 private:
  bool counting() const { return trace_ && (control_ & 1u) != 0; }
  std::uint32_t count() const;
  void rebase(std::uint32_t value);

  std::function<std::uint64_t()> cycles_;
  bool trace_ = false;
  std::uint32_t control_ = 0;
  std::uint32_t base_ = 0;
  std::uint64_t base_cycles_ = 0;
};

// A few words with fixed or remembered values; other offsets read 0.
class StoredWords final : public stm32::Peripheral {
 public:
  StoredWords(const char* name, std::uint32_t id) : name_(name), id_(id) {}
  const char* name() const override { return name_; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override {}

 private:
  const char* name_;
  std::uint32_t id_;  // word 0, read only
  std::uint32_t words_[4] = {};
};

}  // namespace whirl::board
