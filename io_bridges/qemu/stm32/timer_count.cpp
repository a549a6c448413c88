// The counter of a timer: how it gets from one moment to a later one, and what it passes.
//
//   A run goes in one direction and ends one step before a turn: overflow, underflow, or the
//   wrap of a counter that was above ARR. Matches inside a run and at turns set flags and OCxREF.
#include "base/check.hpp"
#include "io_bridges/qemu/stm32/timer.hpp"

namespace whirl::stm32 {

using namespace tim;

bool Timer::counts_clock() const {
  if ((cr1_ & CEN) == 0 || encoder() || slave_mode() == 7 || (smcr_ & ECE) != 0) return false;
  return slave_mode() != 5 || gate_;
}

void Timer::sync() {
  advance(grid_.ticks(chip_.events.now()));
}

void Timer::advance(std::int64_t now_tick) {
  while (counts_clock() && !blocked()) {
    if (now_tick <= anchor_) return;
    const std::int64_t steps = (psc_count_ + now_tick - anchor_) / divider();
    const std::int64_t to_turn = steps_to_turn();
    WHIRL_CHECK(to_turn > 0, config_.number, cnt_, arr_shadow_);
    if (steps < to_turn) {
      run(steps);
      psc_count_ += now_tick - anchor_ - steps * divider();
      break;
    }
    run(to_turn - 1);
    anchor_ += to_turn * divider() - psc_count_;
    psc_count_ = 0;
    turn();
    skip_equal_periods(now_tick);
  }
  if (now_tick > anchor_) anchor_ = now_tick;
}

// CNT_EN follows CEN by one clock.
void Timer::enable() {
  if ((cr1_ & CEN) != 0) return;
  cr1_ |= CEN;
  anchor_ = grid_.ticks(chip_.events.now()) + 1;
  pattern_dirty_ = phase_changed_ = true;
}

void Timer::step_once() {
  if ((cr1_ & CEN) == 0 || ++psc_count_ < divider()) return;
  psc_count_ = 0;
  if (blocked()) return;
  if (steps_to_turn() <= 1) {
    turn();
  } else {
    run(1);
  }
}

// Centre-aligned counting turns at both ends, also when CNT was written there.
void Timer::normalise_direction() {
  if (!centre()) return;
  if (cnt_ == 0) {
    down_ = false;
  } else if (cnt_ == arr_shadow_) {
    down_ = true;
  }
}

std::int64_t Timer::steps_to_turn() const {
  const std::int64_t cnt = cnt_;
  if (down_) return centre() ? cnt : cnt + 1;
  if (cnt > arr_shadow_ || (centre() && cnt == arr_shadow_)) return max_count() - cnt + 1;
  return arr_shadow_ - cnt + (centre() ? 0 : 1);
}

void Timer::run(std::int64_t steps) {
  if (steps <= 0) return;
  const std::int64_t from = cnt_;
  const std::int64_t to = down_ ? from - steps : from + steps;
  const bool flagged = !centre() || cms() == 3 || cms() == (down_ ? 1u : 2u);
  for (int ch = 0; ch < can_.channels; ++ch) {
    const std::int64_t ccr = channel_[ch].shadow;
    const bool passed = down_ ? ccr >= to && ccr < from : ccr > from && ccr <= to;
    if (passed && is_output(ch)) match(ch, flagged);
  }
  cnt_ = static_cast<std::uint32_t>(to);
}

void Timer::turn() {
  ++turns_;
  if (!down_ && cnt_ > arr_shadow_) {  // ARR was lowered below CNT: wraps without an event
    cnt_ = 0;
    land();
    return;
  }
  if (!down_) {
    for (int ch = 0; ch < can_.channels; ++ch) {
      if (channel_[ch].shadow > arr_shadow_ && is_output(ch)) sr_ |= CC1IF << ch;
    }
  }
  if (centre()) {
    cnt_ = down_ ? 0 : arr_shadow_;
    down_ = !down_;
    land();
    repeat_or_update();
  } else {
    repeat_or_update();
    cnt_ = down_ ? arr_shadow_ : 0;
    land();
  }
}

void Timer::land() {
  for (int ch = 0; ch < can_.channels; ++ch) {
    if (channel_[ch].shadow == cnt_ && is_output(ch)) match(ch, true);
  }
}

std::int64_t Timer::matches_per_period(int ch) const {
  const std::uint32_t ccr = channel_[ch].shadow;
  if (ccr > arr_shadow_) return 0;
  return centre() && ccr != 0 && ccr != arr_shadow_ ? 2 : 1;
}

// Once all shadows hold, one round of the repetition counter is as good as the next.
void Timer::skip_equal_periods(std::int64_t now_tick) {
  const std::int64_t rounds = can_.advanced ? rcr_ + 1 : 1;
  const bool one_pulse = (cr1_ & (OPM | UDIS)) == OPM;  // without updates it never ends
  if (turns_ < 4 * rounds || one_pulse || cnt_ > arr_shadow_ || !shadows_settled()) return;
  const std::int64_t arr = arr_shadow_;
  const std::int64_t span = (centre() ? 2 * arr : arr + 1) * rounds * divider();
  const std::int64_t skipped = (now_tick - anchor_) / span;
  if (skipped <= 0) return;
  anchor_ += skipped * span;
  for (int ch = 0; ch < can_.channels; ++ch) {
    const std::int64_t matches = matches_per_period(ch) * rounds * skipped;
    if (output_mode(ch) == 3 && is_output(ch) && matches % 2 != 0) {
      channel_[ch].ref = !channel_[ch].ref;
    }
  }
}

bool Timer::shadows_settled() const {
  if ((cr1_ & UDIS) != 0) return true;
  if (psc_ != psc_shadow_ || arr_ != arr_shadow_) return false;
  for (int ch = 0; ch < can_.channels; ++ch) {
    if (is_output(ch) && channel_[ch].ccr != channel_[ch].shadow) return false;
  }
  return true;
}

void Timer::repeat_or_update() {
  if (repetitions_ > 0) {
    --repetitions_;
    return;
  }
  update_event(true);
}

void Timer::update_event(bool from_overflow) {
  repetitions_ = rcr_;
  if ((cr1_ & UDIS) != 0) return;
  load_shadows();
  if ((cr1_ & OPM) != 0) {
    cr1_ &= ~CEN;
    pattern_dirty_ = true;
  }
  if ((bdtr_ & AOE) != 0 && (bdtr_ & MOE) == 0 && !break_active()) {
    bdtr_ |= MOE;
    pattern_dirty_ = true;
  }
  if (from_overflow || (cr1_ & URS) == 0) {
    sr_ |= UIF;
    if ((dier_ & UDE) != 0) raise(kUpdate);
  }
  for (int ch = 0; ch < can_.channels && (cr2_ & CCDS) != 0; ++ch) {
    if ((dier_ & (CC1DE << ch)) != 0) raise(ch + 1);
  }
  if (master_mode() == 2) ++pulses_;
}

void Timer::load_shadows() {
  bool changed = psc_shadow_ != psc_ || arr_shadow_ != arr_;
  psc_shadow_ = psc_;
  arr_shadow_ = arr_;
  for (int ch = 0; ch < can_.channels; ++ch) {
    Channel& c = channel_[ch];
    if (!is_output(ch) || c.shadow == c.ccr) continue;
    c.shadow = c.ccr;
    changed = true;
  }
  if (!changed) return;
  turns_ = 0;
  pattern_dirty_ = true;
}

// UG, or a trigger in reset mode.
void Timer::restart_count() {
  update_event(false);
  psc_count_ = 0;
  if (centre()) down_ = false;
  cnt_ = down_ ? arr_shadow_ : 0;
  turns_ = 0;
  pattern_dirty_ = phase_changed_ = true;
  if ((cr1_ & CEN) != 0) land();  // a counter that stands compares nothing
  if (master_mode() == 0) ++pulses_;
}

void Timer::match(int ch, bool flagged) {
  Channel& c = channel_[ch];
  const unsigned mode = output_mode(ch);
  if (mode == 1 || mode == 2) c.ref = mode == 1;
  if (mode == 3) c.ref = !c.ref;
  if (!flagged) return;
  sr_ |= CC1IF << ch;
  if ((dier_ & (CC1DE << ch)) != 0 && (cr2_ & CCDS) == 0) raise(ch + 1);
  if (ch == 0 && master_mode() == 3) ++pulses_;
}

}  // namespace whirl::stm32
