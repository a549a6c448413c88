// The RTC of F103 (a 32-bit counter behind a 20-bit prescaler) and its backup registers BKP.
//
//   Source   RM0008 ch. 6 and 18. Writes to PRL, CNT and ALR need CNF and act when CNF falls; RTOFF
//            falls for three RTCCLK periods after each; RSF rises after the next RTCCLK edge
//   Kept     all of it across a system reset, except CRH and CRL
//   Left out BKP tamper detection and calibration output (their registers are stored)
#pragma once
#include <array>
#include <functional>

#include "io_bridges/qemu/stm32/irq_line.hpp"
#include "io_bridges/qemu/stm32/peripheral.hpp"
#include "io_bridges/qemu/stm32/tick_grid.hpp"

namespace whirl::stm32 {

class RtcF1 : public Peripheral {
 public:
  RtcF1(const Chip& chip, int irq, std::function<double()> rtcclk_Hz,
        std::function<bool()> writable, std::function<void(int, bool)> exti);
  const char* name() const override { return "RTC"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;
  void reset_backup_domain();
  void clock_changed();

 private:
  std::int64_t ticks() const { return grid_.ticks(chip_.events.now()); }
  std::int64_t period() const { return static_cast<std::int64_t>(prl_) + 1; }
  void sync();
  void commit();
  void arm();
  void update_lines();
  std::uint32_t status() const;
  void write_status(std::uint32_t value);

  Chip chip_;
  IrqLine irq_;
  std::function<double()> rtcclk_Hz_;
  std::function<bool()> writable_;
  std::function<void(int, bool)> exti_;
  TickGrid grid_;
  io::Event event_;
  std::uint32_t crh_ = 0, flags_ = 0;
  bool configuring_ = false;
  std::uint32_t prl_ = 0x8000, alarm_ = 0xFFFFFFFF, count_ = 0;
  std::uint32_t new_prl_ = 0x8000, new_alarm_ = 0xFFFFFFFF, new_count_ = 0;
  bool count_written_ = false;
  std::int64_t anchor_ = 0;  // clock edge at which count_ began
  std::int64_t busy_until_ = 0, synced_from_ = 0;
};

class BackupRegisters : public Peripheral {
 public:
  explicit BackupRegisters(std::function<bool()> writable) : writable_(std::move(writable)) {}
  const char* name() const override { return "BKP"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override {}  // survives a system reset
  void reset_backup_domain() { words_ = {}; }

 private:
  std::function<bool()> writable_;
  std::array<std::uint32_t, 48> words_{};
};

}  // namespace whirl::stm32
