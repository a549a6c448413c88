// The RTC of F405: calendar, alarms, wake-up timer, backup registers.
//
//   Time     the calendar is computed from RTCCLK's edges; an event is set for alarms (one look per
//            candidate instant) and the wake-up timer only
//   Locks    PWR_CR.DBP for every write, the WPR keys for all but ISR flags, TAFCR and BKPxR; TR,
//            DR and PRER only in initialisation mode. Both modes take two RTCCLK periods to begin
//   Kept     across a system reset; only the backup domain reset (or power-on) clears
//   Source   RM0090 ch. 26
//   Left out time stamp, tamper, digital calibration (CALR, CALIBR are stored), RTC_OUT, DST memory
#pragma once
#include <array>
#include <functional>
#include <memory>

#include "io_bridges/qemu/stm32/peripheral.hpp"
#include "io_bridges/qemu/stm32/tick_grid.hpp"

namespace whirl::stm32 {

struct RtcHost {
  std::function<double()> rtcclk_Hz;
  std::function<bool()> writable;                  // PWR_CR.DBP
  std::function<void(int line, bool level)> exti;  // 17 alarm, 22 wake-up
};

class Rtc : public Peripheral {
 public:
  Rtc(const Chip& chip, RtcHost host);
  const char* name() const override { return "RTC"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;  // system reset: shadow registers and RSF only
  void reset_backup_domain();
  void clock_changed();

 private:
  struct Alarm {
    std::uint32_t fields = 0, subseconds = 0;
    bool flag = false;
    std::unique_ptr<io::Event> event;
  };

  std::uint32_t read_word(std::uint32_t offset);
  void write_word(std::uint32_t offset, std::uint32_t value);
  void write_protected(std::uint32_t offset, std::uint32_t value);
  void write_isr(std::uint32_t value);
  void write_cr(std::uint32_t value);
  std::uint32_t isr() const;

  std::int64_t ticks() const { return grid_.ticks(chip_.events.now()); }
  std::int64_t sub_period() const { return (prer_ >> 16 & 0x7F) + 1; }
  std::int64_t second_period() const { return sub_period() * ((prer_ & 0x7FFF) + 1); }
  bool initialising() const { return init_ && ticks() >= init_since_ + 2; }
  std::int64_t elapsed() const;  // ticks of the calendar since its anchor
  std::int64_t seconds() const;  // since 2000-01-01 00:00
  std::uint32_t subsecond() const;
  std::uint32_t time_register(std::int64_t seconds) const;
  std::uint32_t date_register(std::int64_t seconds) const;
  void set_time(std::uint32_t tr);
  void set_date(std::uint32_t dr);
  void stop_calendar();
  void start_calendar();

  void arm_alarms();
  void arm(int which, bool past_now);
  void look(int which);
  bool alarm_matches(const Alarm& alarm) const;
  void arm_wakeup(bool first);
  std::int64_t wakeup_ticks() const;
  void update_lines();

  Chip chip_;
  RtcHost host_;
  TickGrid grid_;
  std::int64_t base_seconds_ = 0;  // the calendar at anchor_
  std::int64_t anchor_ = 0;
  int weekday_shift_ = 0;  // written weekday minus the true one
  bool init_ = false;
  std::int64_t init_since_ = 0, synced_from_ = 0, wakeup_off_since_ = 0;
  bool initialised_ = false, synced_ = false, locked_ = true, wakeup_flag_ = false;
  std::uint32_t key_ = 0;
  std::uint32_t cr_ = 0, prer_ = 0x007F00FF, wutr_ = 0xFFFF, calibr_ = 0, calr_ = 0, tafcr_ = 0;
  bool frozen_time_ = false, frozen_date_ = false;  // shadows held until DR is read
  std::uint32_t shadow_time_ = 0, shadow_date_ = 0;
  std::array<Alarm, 2> alarm_;
  io::Event wakeup_;
  std::int64_t wakeup_due_ = 0;
  std::array<std::uint32_t, 20> backup_{};
};

}  // namespace whirl::stm32
