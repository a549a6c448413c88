// The output side of a timer: OCxREF, dead time, pins, TRGO levels, and the observer's pattern.
#include <algorithm>

#include "io_bridges/qemu/stm32/register_access.hpp"
#include "io_bridges/qemu/stm32/timer.hpp"

namespace whirl::stm32 {

using namespace tim;

// What a register write makes act at once: everything that has no preload switched on.
void Timer::follow_writes() {
  if ((cr2_ & CCPC) == 0 || !can_.advanced) {
    active_ccmr_ = ccmr_;
    active_ccer_ = ccer_;
  }
  if ((cr1_ & ARPE) == 0 && arr_shadow_ != arr_) {
    arr_shadow_ = arr_;
    turns_ = 0;
    pattern_dirty_ = true;
    normalise_direction();
  }
  for (int ch = 0; ch < can_.channels; ++ch) {
    Channel& c = channel_[ch];
    if (!is_output(ch) || bit(ccmr(ch), 3) || c.shadow == c.ccr) continue;
    c.shadow = c.ccr;
    turns_ = 0;
    pattern_dirty_ = true;
  }
}

void Timer::com_event() {
  active_ccmr_ = ccmr_;
  active_ccer_ = ccer_;
  sr_ |= COMIF;
  pattern_dirty_ = true;
  if ((dier_ & COMDE) != 0) raise(kCom);
}

// PWM mode 1: up-counting active below CCR, down-counting active up to CCR.
bool Timer::pwm_reference(int ch) const {
  const std::uint32_t ccr = channel_[ch].shadow;
  return down_ ? cnt_ <= ccr : cnt_ < ccr;
}

void Timer::refresh_reference(int ch) {
  Channel& c = channel_[ch];
  const bool was = c.ref;
  const unsigned mode = output_mode(ch);
  if (mode == 4 || mode == 5) c.ref = mode == 5;
  if (mode >= 6) c.ref = pwm_reference(ch) == (mode == 6);
  if (c.ref != was) reference_changed(ch);
}

void Timer::reference_changed(int ch) {
  const bool both = ((active_ccer_ >> (4 * ch)) & 5) == 5;
  const bool seen = pins_[ch]->routed() || pins_n_[ch]->routed();
  const std::int64_t ticks = dead_ticks();
  if (!can_.advanced || !both || !seen || ticks == 0 || grid_.frequency_Hz() == 0) return;
  channel_[ch].dead = true;
  dead_time_[ch]->at(grid_.time(grid_.ticks(chip_.events.now()) + ticks));
}

// DTG in clocks of the timer: t_DTS is 1, 2 or 4 of them.
std::int64_t Timer::dead_ticks() const {
  const std::int64_t dts = std::int64_t{1} << std::min<std::uint32_t>(field(cr1_, 8, 2), 2);
  const std::int64_t dtg = bdtr_ & 0xFF;
  if (dtg < 0x80) return dtg * dts;
  if (dtg < 0xC0) return (64 + (dtg & 63)) * 2 * dts;
  return (32 + (dtg & 31)) * (dtg < 0xE0 ? 8 : 16) * dts;
}

void Timer::refresh_outputs() {
  const Nanoseconds now = chip_.events.now();
  for (int ch = 0; ch < can_.channels; ++ch) {
    if (is_output(ch)) refresh_reference(ch);
    drive_pins(ch);
    const std::uint32_t enables = active_ccer_ >> (4 * ch);
    if (is_output(ch))
      compare_[ch].set(bit(enables, 0) && channel_[ch].ref != bit(enables, 1), now);
  }
  set_master_line();
  notify_observer();
}

void Timer::drive_pins(int ch) {
  const Nanoseconds now = chip_.events.now();
  pins_[ch]->drive(output_now(ch, false), now);
  if (can_.advanced && ch < 3) pins_n_[ch]->drive(output_now(ch, true), now);
}

Drive Timer::output(int channel, bool complementary) {
  sync();
  settle();
  return output_now(channel - 1, complementary);
}

// RM0090 table "Output control bits for complementary OCx and OCxN channels with break feature".
Drive Timer::output_now(int ch, bool complementary) const {
  if (!is_output(ch)) return Drive::none;
  const auto to_drive = [](bool level) { return level ? Drive::high : Drive::low; };
  const std::uint32_t enables = active_ccer_ >> (4 * ch);
  const bool on = bit(enables, 0), on_n = bit(enables, 2) && can_.advanced && ch < 3;
  const bool inverted = bit(enables, complementary ? 3 : 1);
  const Channel& c = channel_[ch];
  if (can_.advanced && (bdtr_ & MOE) == 0)
    return on || on_n ? idle_output(ch, complementary) : Drive::none;
  if (!(complementary ? on_n : on)) {
    const bool off_state = can_.advanced && (bdtr_ & OSSR) != 0 && (on || on_n);
    return off_state ? to_drive(inverted) : Drive::none;
  }
  if (on && on_n) return to_drive((!c.dead && c.ref != complementary) != inverted);
  return to_drive(c.ref != inverted);
}

Drive Timer::idle_output(int ch, bool complementary) const {
  if ((bdtr_ & OSSI) == 0) return Drive::none;
  const bool idle = bit(cr2_, 8 + 2 * static_cast<unsigned>(ch) + (complementary ? 1 : 0));
  return idle ? Drive::high : Drive::low;
}

void Timer::set_master_line() {
  const unsigned mode = master_mode();
  const bool level = mode == 1               ? (cr1_ & CEN) != 0
                     : mode >= 4 && mode < 8 ? channel_[mode - 4].ref
                                             : false;
  trgo_.set(level, chip_.events.now());
}

void Timer::observe_pwm(std::function<void(const PwmPattern&)> observer) {
  observer_ = std::move(observer);
  sync();
  pattern_dirty_ = true;
  settle();
}

PwmChannel Timer::pwm_channel(int ch) const {
  PwmChannel out;
  if (!is_output(ch)) return out;
  const std::uint32_t enables = active_ccer_ >> (4 * ch);
  const unsigned mode = output_mode(ch);
  const double arr = arr_shadow_, ccr = channel_[ch].shadow;
  out.driven = output_now(ch, false) != Drive::none;
  out.driven_n = can_.advanced && ch < 3 && output_now(ch, true) != Drive::none;
  out.active_low = bit(enables, 1);
  out.active_low_n = bit(enables, 3);
  out.complementary = can_.advanced && (enables & 5) == 5;
  out.inverted = mode == 7;
  if (mode >= 6 && arr > 0) {
    const double whole = centre() ? arr : arr + 1;
    const double active = down_ && !centre() ? ccr + 1 : ccr;
    out.duty = std::min(active / whole, 1.0);
    if (mode == 7) out.duty = 1.0 - out.duty;
    out.modulated = out.duty > 0.0 && out.duty < 1.0;
  } else {
    out.modulated = mode == 3 && (cr1_ & CEN) != 0;
    out.duty = out.modulated ? 0.5 : channel_[ch].ref ? 1.0 : 0.0;
  }
  if (can_.advanced && (bdtr_ & MOE) == 0) {
    out.modulated = false;
    out.duty = 0.0;
  }
  return out;
}

PwmPattern Timer::pwm_pattern() {
  PwmPattern now;
  const double hertz = static_cast<double>(grid_.frequency_Hz());
  const std::int64_t arr = arr_shadow_;
  now.counting = (cr1_ & CEN) != 0 && !blocked();
  now.centre_aligned = centre();
  now.down = down_ && !centre();
  if (hertz > 0.0) {
    const std::int64_t steps = centre() ? 2 * arr : arr + 1;
    now.period_s = static_cast<double>(steps * divider()) / hertz;
    now.dead_time_s = can_.advanced ? static_cast<double>(dead_ticks()) / hertz : 0.0;
  }
  for (int ch = 0; ch < can_.channels; ++ch)
    now.channel[static_cast<std::size_t>(ch)] = pwm_channel(ch);
  const std::int64_t cnt = cnt_;
  const std::int64_t into = centre() ? (down_ ? 2 * arr - cnt : cnt) : down_ ? arr - cnt : cnt;
  now.period_start_ns = grid_.time(anchor_ - psc_count_ - into * divider());
  now.t_ns = chip_.events.now();
  return now;
}

void Timer::notify_observer() {
  if (!pattern_dirty_ || !observer_) return;
  pattern_dirty_ = false;
  const PwmPattern pattern = pwm_pattern();
  const bool same = !phase_changed_ && pattern.counting == told_.counting &&
                    pattern.channel == told_.channel && pattern.down == told_.down &&
                    pattern.centre_aligned == told_.centre_aligned &&
                    pattern.period_s == told_.period_s && pattern.dead_time_s == told_.dead_time_s;
  phase_changed_ = false;
  if (same) return;
  told_ = pattern;
  observer_(pattern);
}

}  // namespace whirl::stm32
