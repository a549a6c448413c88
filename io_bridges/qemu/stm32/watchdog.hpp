// IWDG and WWDG.
//
//   IWDG     resets (RLR + 1) * 4 * 2^PR periods of LSI after the last reload; PVU and RVU stay up
//            for five LSI periods after a write
//   WWDG     T counts down every 4096 * 2^WDGTB periods of PCLK1; reset when T6 falls, or when
//            software reloads while T > W; early wake-up at T = 0x40
//   Source   RM0090 ch. 21, 22; RM0008 ch. 19, 20
//   Left out the free-running prescaler phase of WWDG: a write to T starts a full period
#pragma once
#include <functional>

#include "io_bridges/qemu/stm32/irq_line.hpp"
#include "io_bridges/qemu/stm32/peripheral.hpp"
#include "io_bridges/qemu/stm32/tick_grid.hpp"

namespace whirl::stm32 {

class IndependentWatchdog : public Peripheral {
 public:
  IndependentWatchdog(const Chip& chip, std::function<void()> bite);
  const char* name() const override { return "IWDG"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;
  bool running() const { return running_; }

 private:
  void key(std::uint32_t value);
  void arm();
  Nanoseconds lsi_periods_ns(double periods) const;
  void settle();

  Chip chip_;
  io::Event bite_;
  bool running_ = false, unlocked_ = false;
  std::uint32_t prescaler_ = 0, reload_ = 0xFFF;            // as written
  std::uint32_t live_prescaler_ = 0, live_reload_ = 0xFFF;  // as counted with
  std::uint32_t count_ = 0xFFF;                             // that the next period starts from
  Nanoseconds prescaler_ready_ = 0, reload_ready_ = 0;
};

class WindowWatchdog : public Peripheral {
 public:
  WindowWatchdog(const Chip& chip, int irq, std::function<void()> bite);
  const char* name() const override { return "WWDG"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;

 private:
  std::uint32_t count();
  void write_control(std::uint32_t value);
  void arm();
  std::int64_t clocks_per_count() const { return std::int64_t{4096} << ((cfr_ >> 7) & 3); }

  Chip chip_;
  TickGrid grid_;
  io::Event early_, bite_event_;
  std::function<void()> bite_;
  IrqLine irq_;
  bool active_ = false, early_flag_ = false;
  std::uint32_t cfr_ = 0x7F, written_ = 0x7F;
  std::int64_t written_at_ = 0;
};

}  // namespace whirl::stm32
