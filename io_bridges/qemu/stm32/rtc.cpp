#include "io_bridges/qemu/stm32/rtc.hpp"

#include "io_bridges/qemu/stm32/register_access.hpp"
#include "io_bridges/qemu/stm32/rtc_calendar.hpp"

namespace whirl::stm32 {

namespace {

enum : std::uint32_t {
  TR = 0x00,
  DR = 0x04,
  CR = 0x08,
  ISR = 0x0C,
  PRER = 0x10,
  WUTR = 0x14,
  CALIBR = 0x18,
  ALRMAR = 0x1C,
  ALRMBR = 0x20,
  WPR = 0x24,
  SSR = 0x28,
  SHIFTR = 0x2C,
  CALR = 0x3C,
  TAFCR = 0x40,
  ALRMASSR = 0x44,
  ALRMBSSR = 0x48,
  BKP0R = 0x50,
  BKP19R = 0x9C,
};
constexpr std::uint32_t BYPSHAD = 1u << 5, FMT = 1u << 6, ALRAE = 1u << 8, WUTE = 1u << 10,
                        ADD1H = 1u << 16, SUB1H = 1u << 17;
constexpr std::uint32_t WUTWF = 1u << 2, INITS = 1u << 4, RSF = 1u << 5, INITF = 1u << 6,
                        INIT = 1u << 7, ALRAF = 1u << 8, WUTF = 1u << 10;
constexpr std::int64_t kDay_s = 86400;

}  // namespace

Rtc::Rtc(const Chip& chip, RtcHost host)
    : chip_(chip), host_(std::move(host)), wakeup_(chip.events, [this] {
        wakeup_flag_ = true;
        arm_wakeup(false);
        update_lines();
      }) {
  for (int i = 0; i < 2; ++i) {
    alarm_[static_cast<std::size_t>(i)].event =
        std::make_unique<io::Event>(chip.events, [this, i] { look(i); });
  }
  clock_changed();
}

void Rtc::clock_changed() {
  const std::int64_t before_Hz = grid_.frequency_Hz();
  grid_.set_frequency(host_.rtcclk_Hz ? host_.rtcclk_Hz() : 0.0, chip_.events.now());
  if (grid_.frequency_Hz() == before_Hz) return;
  arm_alarms();
  arm_wakeup(true);
}

void Rtc::reset() {
  synced_ = false;
  synced_from_ = ticks();
  frozen_time_ = frozen_date_ = false;
  if (init_) start_calendar();
  init_ = false;
}

void Rtc::reset_backup_domain() {
  reset();
  locked_ = true;
  base_seconds_ = 0;
  anchor_ = ticks();
  weekday_shift_ = 0;
  initialised_ = wakeup_flag_ = false;
  cr_ = calibr_ = calr_ = tafcr_ = 0;
  prer_ = 0x007F00FF;
  wutr_ = 0xFFFF;
  for (Alarm& alarm : alarm_) {
    alarm.fields = alarm.subseconds = 0;
    alarm.flag = false;
    alarm.event->cancel();
  }
  wakeup_.cancel();
  backup_ = {};
  update_lines();
}

std::int64_t Rtc::elapsed() const {
  return init_ ? 0 : ticks() - anchor_;
}

std::int64_t Rtc::seconds() const {
  return base_seconds_ + elapsed() / second_period();
}

std::uint32_t Rtc::subsecond() const {
  return (prer_ & 0x7FFF) - static_cast<std::uint32_t>(elapsed() % second_period() / sub_period());
}

std::uint32_t Rtc::time_register(std::int64_t seconds) const {
  const std::int64_t of_day = seconds % kDay_s;
  std::int64_t hour = of_day / 3600;
  std::uint32_t afternoon = 0;
  if ((cr_ & FMT) != 0) {
    afternoon = hour >= 12 ? 1u << 22 : 0;
    hour = hour % 12 == 0 ? 12 : hour % 12;
  }
  return afternoon | to_bcd(hour) << 16 | to_bcd(of_day / 60 % 60) << 8 | to_bcd(of_day % 60);
}

std::uint32_t Rtc::date_register(std::int64_t seconds) const {
  const std::int64_t days = seconds / kDay_s;
  const CivilDate date = date_of(days);
  // Day 0 counts as a Monday when nothing was written: DR resets to weekday 1.
  const auto weekday = static_cast<std::uint32_t>((days + weekday_shift_) % 7 + 1);
  return to_bcd(date.year) << 16 | weekday << 13 | to_bcd(date.month) << 8 | to_bcd(date.day);
}

void Rtc::set_time(std::uint32_t tr) {
  int hour = from_bcd(field(tr, 16, 6));
  if ((cr_ & FMT) != 0) hour = hour % 12 + (bit(tr, 22) ? 12 : 0);
  base_seconds_ = base_seconds_ / kDay_s * kDay_s + hour * 3600LL +
                  from_bcd(field(tr, 8, 7)) * 60LL + from_bcd(field(tr, 0, 7));
}

void Rtc::set_date(std::uint32_t dr) {
  const CivilDate date{from_bcd(field(dr, 16, 8)), from_bcd(field(dr, 8, 5)),
                       from_bcd(field(dr, 0, 6))};
  const std::int64_t days = days_since_2000(date);
  base_seconds_ = days * kDay_s + base_seconds_ % kDay_s;
  const int weekday = static_cast<int>(field(dr, 13, 3));
  weekday_shift_ = static_cast<int>(((weekday - 1 - days) % 7 + 7) % 7);
  initialised_ = date.year != 0;
}

void Rtc::stop_calendar() {
  base_seconds_ = seconds();
  init_ = true;
  init_since_ = ticks();
  synced_ = false;
}

void Rtc::start_calendar() {
  init_ = false;
  anchor_ = ticks();
  synced_from_ = anchor_;
  arm_alarms();
}

std::uint32_t Rtc::isr() const {
  std::uint32_t word = initialised_ ? INITS : 0;
  const std::int64_t now = ticks();
  for (std::uint32_t i = 0; i < 2; ++i) {
    const Alarm& alarm = alarm_[i];
    if ((cr_ & (ALRAE << i)) == 0) word |= 1u << i;
    if (alarm.flag) word |= ALRAF << i;
  }
  if ((cr_ & WUTE) == 0 && (wakeup_off_since_ == 0 || now >= wakeup_off_since_ + 2)) word |= WUTWF;
  if (wakeup_flag_) word |= WUTF;
  if (synced_ || (!init_ && grid_.frequency_Hz() > 0 && now >= synced_from_ + 2)) word |= RSF;
  if (initialising()) word |= INITF;
  if (init_) word |= INIT;
  return word;
}

std::uint32_t Rtc::read(std::uint32_t offset, unsigned size) {
  return part_of_word(read_word(offset & ~3u), offset, size);
}

// Reading SSR or TR holds the higher registers until DR is read, unless BYPSHAD.
std::uint32_t Rtc::read_word(std::uint32_t offset) {
  if (offset >= BKP0R && offset <= BKP19R) return backup_[(offset - BKP0R) / 4];
  const bool held = (cr_ & BYPSHAD) == 0;
  switch (offset) {
    case SSR:
    case TR: {
      const std::int64_t now = seconds();
      if (offset == TR && frozen_time_) return shadow_time_;
      if (held && !frozen_date_) shadow_date_ = date_register(now), frozen_date_ = true;
      if (offset == TR) return time_register(now);
      if (held) shadow_time_ = time_register(now), frozen_time_ = true;
      return subsecond();
    }
    case DR: {
      const bool frozen = frozen_date_;
      frozen_time_ = frozen_date_ = false;
      return frozen ? shadow_date_ : date_register(seconds());
    }
    case CR:
      return cr_;
    case ISR:
      return isr();
    case PRER:
      return prer_;
    case WUTR:
      return wutr_;
    case CALIBR:
      return calibr_;
    case ALRMAR:
      return alarm_[0].fields;
    case ALRMBR:
      return alarm_[1].fields;
    case CALR:
      return calr_;
    case TAFCR:
      return tafcr_;
    case ALRMASSR:
      return alarm_[0].subseconds;
    case ALRMBSSR:
      return alarm_[1].subseconds;
    default:
      return 0;
  }
}

void Rtc::write(std::uint32_t offset, std::uint32_t value, unsigned size) {
  if (host_.writable && !host_.writable()) return;
  write_word(offset & ~3u, on_all_lanes(value, size));
}

void Rtc::write_word(std::uint32_t offset, std::uint32_t value) {
  if (offset >= BKP0R && offset <= BKP19R) {
    backup_[(offset - BKP0R) / 4] = value;
  } else if (offset == WPR) {
    locked_ = locked_ ? !(key_ == 0xCA && (value & 0xFF) == 0x53) : false;
    if ((value & 0xFF) != 0x53 && (value & 0xFF) != 0xCA) locked_ = true;
    key_ = value & 0xFF;
  } else if (offset == TAFCR) {
    tafcr_ = value & 0x7FFFF;
  } else if (offset == ISR) {
    write_isr(value);
  } else if (!locked_) {
    write_protected(offset, value);
  }
}

void Rtc::write_isr(std::uint32_t value) {
  for (std::uint32_t i = 0; i < 2; ++i) {
    if ((value & (ALRAF << i)) == 0) alarm_[i].flag = false;
  }
  if ((value & WUTF) == 0) wakeup_flag_ = false;
  update_lines();
  if (locked_) return;
  if ((value & RSF) == 0) {
    synced_ = false;
    synced_from_ = ticks();
    frozen_time_ = frozen_date_ = false;
  }
  if ((value & INIT) != 0 && !init_) stop_calendar();
  if ((value & INIT) == 0 && init_) start_calendar();
}

void Rtc::write_cr(std::uint32_t value) {
  const std::uint32_t before = cr_;
  cr_ = value & 0x00FCFFFF & ~(ADD1H | SUB1H);
  if ((value & ADD1H) != 0) base_seconds_ += 3600;
  if ((value & SUB1H) != 0) base_seconds_ -= base_seconds_ >= 3600 ? 3600 : 0;
  if ((before & WUTE) != 0 && (cr_ & WUTE) == 0) wakeup_off_since_ = ticks();
  if (((before ^ cr_) & (WUTE | 7)) != 0) arm_wakeup(true);
  arm_alarms();
  update_lines();
}

void Rtc::write_protected(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case TR:
      if (initialising()) set_time(value);
      break;
    case DR:
      if (initialising()) set_date(value);
      break;
    case CR:
      write_cr(value);
      break;
    case PRER:
      if (initialising()) prer_ = value & 0x007F7FFF;
      break;
    case WUTR:
      if ((cr_ & WUTE) == 0) wutr_ = value & 0xFFFF;
      break;
    case CALIBR:
      calibr_ = value & 0x9F;
      break;
    case CALR:
      calr_ = value & 0xE1FF;
      break;
    case ALRMAR:
      alarm_[0].fields = value;
      break;
    case ALRMBR:
      alarm_[1].fields = value;
      break;
    case ALRMASSR:
      alarm_[0].subseconds = value & 0x0F007FFF;
      break;
    case ALRMBSSR:
      alarm_[1].subseconds = value & 0x0F007FFF;
      break;
    case SHIFTR:
      if (bit(value, 31)) ++base_seconds_;
      anchor_ += static_cast<std::int64_t>(value & 0x7FFF) * sub_period();
      break;
    default:
      break;
  }
  arm_alarms();
}

}  // namespace whirl::stm32
