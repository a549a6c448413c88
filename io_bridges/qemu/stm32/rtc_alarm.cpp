// Alarms and the wake-up timer of the RTC.
#include "io_bridges/qemu/stm32/register_access.hpp"
#include "io_bridges/qemu/stm32/rtc.hpp"

namespace whirl::stm32 {

namespace {

constexpr std::uint32_t ALRAE = 1u << 8, WUTE = 1u << 10, ALRAIE = 1u << 12, WUTIE = 1u << 14;
constexpr std::uint32_t MSK1 = 1u << 7, MSK2 = 1u << 15, MSK3 = 1u << 23, MSK4 = 1u << 31,
                        WDSEL = 1u << 30;
constexpr int kAlarmLine = 17, kWakeupLine = 22;

}  // namespace

void Rtc::update_lines() {
  if (!host_.exti) return;
  bool alarm = false;
  for (std::uint32_t i = 0; i < 2; ++i) {
    alarm = alarm || (alarm_[i].flag && (cr_ & (ALRAIE << i)) != 0);
  }
  host_.exti(kAlarmLine, alarm);
  host_.exti(kWakeupLine, wakeup_flag_ && (cr_ & WUTIE) != 0);
}

void Rtc::arm_alarms() {
  arm(0, true);
  arm(1, true);
}

// The next instant at which the sub-second part agrees: each second, or where SSR's low MASKSS bits
// are those of the alarm.
void Rtc::arm(int which, bool past_now) {
  Alarm& alarm = alarm_[static_cast<std::size_t>(which)];
  alarm.event->cancel();
  if ((cr_ & (ALRAE << which)) == 0 || init_ || grid_.frequency_Hz() == 0) return;
  const std::int64_t sub = sub_period(), in_second = (prer_ & 0x7FFF) + 1;
  const unsigned compared = field(alarm.subseconds, 24, 4);
  const std::int64_t step = compared == 0 ? in_second : std::int64_t{1} << compared;
  const std::int64_t wanted = compared == 0 ? in_second - 1 : (alarm.subseconds & 0x7FFF) % step;
  if (wanted >= in_second) return;
  // In sub-second steps since the anchor; SSR counts down from in_second - 1 in each second.
  std::int64_t at = elapsed() / sub + (past_now ? 1 : 0);
  for (int guard = 0; guard < 3; ++guard) {
    const std::int64_t ssr = in_second - 1 - at % in_second;
    const std::int64_t down = ((ssr - wanted) % step + step) % step;
    if (down <= ssr) {
      at += down;
      break;
    }
    at += ssr + 1;  // not in this second any more
  }
  const Nanoseconds due = grid_.time(anchor_ + at * sub);
  if (due != io::kNever) alarm.event->at(due);
}

void Rtc::look(int which) {
  Alarm& alarm = alarm_[static_cast<std::size_t>(which)];
  if (alarm_matches(alarm)) alarm.flag = true;
  arm(which, true);
  update_lines();
}

bool Rtc::alarm_matches(const Alarm& alarm) const {
  const std::uint32_t time = time_register(seconds()), date = date_register(seconds());
  const std::uint32_t want = alarm.fields;
  if ((want & MSK1) == 0 && field(time, 0, 7) != field(want, 0, 7)) return false;
  if ((want & MSK2) == 0 && field(time, 8, 7) != field(want, 8, 7)) return false;
  if ((want & MSK3) == 0 && field(time, 16, 7) != field(want, 16, 7)) return false;
  if ((want & MSK4) != 0) return true;
  if ((want & WDSEL) != 0) return field(date, 13, 3) == field(want, 24, 4);
  return field(date, 0, 6) == field(want, 24, 6);
}

std::int64_t Rtc::wakeup_ticks() const {
  const std::int64_t count = static_cast<std::int64_t>(wutr_) + 1;
  const unsigned selected = cr_ & 7;
  if (selected < 4) return count * (16 >> selected);
  return (selected >= 6 ? count + 0x10000 : count) * second_period();
}

void Rtc::arm_wakeup(bool first) {
  if ((cr_ & WUTE) == 0 || grid_.frequency_Hz() == 0) {
    wakeup_.cancel();
    return;
  }
  wakeup_due_ = (first ? ticks() : wakeup_due_) + wakeup_ticks();
  const Nanoseconds due = grid_.time(wakeup_due_);
  if (due != io::kNever) wakeup_.at(due);
}

}  // namespace whirl::stm32
