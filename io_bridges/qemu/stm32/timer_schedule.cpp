// Who waits for what of a timer: its one event, its interrupts, its DMA requests.
#include <algorithm>
#include <utility>

#include "io_bridges/qemu/stm32/register_access.hpp"
#include "io_bridges/qemu/stm32/timer.hpp"

namespace whirl::stm32 {

using namespace tim;

// After every access, event and edge: what follows from the new state, outwards.
void Timer::settle() {
  const bool outer = !std::exchange(settling_, true);
  follow_writes();
  refresh_outputs();
  flush();
  schedule();
  if (outer) settling_ = false;
}

bool Timer::level_wanted(int ch) const {
  const std::uint32_t enables = active_ccer_ >> (4 * ch);
  return (pins_[ch]->routed() && bit(enables, 0)) || (pins_n_[ch]->routed() && bit(enables, 2)) ||
         compare_[ch].wanted() ||
         (master_mode() == 4u + static_cast<unsigned>(ch) && trgo_.wanted());
}

bool Timer::match_wanted(int ch) const {
  if (!is_output(ch)) return false;
  if ((dier_ & ~sr_ & (CC1IF << ch)) != 0) return true;
  if ((dier_ & (CC1DE << ch)) != 0 && (cr2_ & CCDS) == 0) return true;
  return level_wanted(ch) || (ch == 0 && master_mode() == 3 && trgo_.wanted());
}

bool Timer::turn_wanted() const {
  if ((dier_ & ~sr_ & UIF) != 0 || (dier_ & UDE) != 0) return true;
  if ((cr2_ & CCDS) != 0 && (dier_ & (15 * CC1DE)) != 0) return true;
  if (trgo_.wanted() && (master_mode() == 2 || (cr1_ & OPM) != 0)) return true;
  if (observer_ && (!shadows_settled() || (cr1_ & OPM) != 0 || (bdtr_ & AOE) != 0)) return true;
  for (int ch = 0; ch < can_.channels; ++ch) {
    if (is_output(ch) && level_wanted(ch)) return true;
  }
  return false;
}

// To the match, or to a turn before it after which to look again.
std::int64_t Timer::steps_to_match(int ch) const {
  const std::int64_t to_turn = steps_to_turn();
  const std::int64_t ccr = channel_[ch].shadow;
  const std::int64_t here = cnt_;
  if (down_ ? ccr < here : ccr > here) {
    const std::int64_t steps = down_ ? here - ccr : ccr - here;
    if (steps < to_turn) return steps;
  }
  const bool plain = !centre() && shadows_settled() && here <= arr_shadow_ && ccr <= arr_shadow_;
  if (!plain) return to_turn;
  return to_turn + (down_ ? arr_shadow_ - ccr : ccr);
}

void Timer::schedule() {
  std::int64_t steps = INT64_MAX;
  if (counts_clock() && !blocked()) {
    if (turn_wanted()) steps = steps_to_turn();
    for (int ch = 0; ch < can_.channels; ++ch) {
      if (match_wanted(ch)) steps = std::min(steps, steps_to_match(ch));
    }
  }
  if (steps == INT64_MAX) {
    event_.cancel();
    return;
  }
  const Nanoseconds due = grid_.time(anchor_ + steps * divider() - psc_count_);
  if (due == io::kNever) {
    event_.cancel();
  } else if (!event_.pending() || event_.due() != due) {
    event_.at(due);
  }
}

void Timer::set_interrupts() {
  const std::uint32_t active = sr_ & dier_;
  const std::uint32_t compare = 15 * CC1IF, trigger = TIF | COMIF;
  if (!can_.advanced) {
    update_irq_.set((active & (UIF | compare | TIF)) != 0);
    return;
  }
  update_irq_.set((active & UIF) != 0);
  compare_irq_.set((active & compare) != 0);
  trigger_irq_.set((active & trigger) != 0);
  break_irq_.set((active & BIF) != 0);
}

// A DMA that serves at once writes our registers from within: the outer round goes on with that.
void Timer::flush() {
  set_interrupts();
  if (flushing_) return;
  flushing_ = true;
  while (raised_ != 0 || pulses_ != 0) {
    if (pulses_ != 0) {
      pulses_ = 0;
      trgo_.pulse(chip_.events.now());
    }
    raise_requests();
  }
  flushing_ = false;
}

void Timer::raise_requests() {
  const std::uint32_t raised = raised_;
  raised_ = 0;
  for (std::size_t i = 0; i < kRequests; ++i) {
    if (((raised >> i) & 1) != 0) dma_[i].set(true);
  }
}

// A request whose service went through DMAR stays until the burst is through.
void Timer::request_served(int request) {
  const bool more = burst_touched_ && burst_index_ != 0;
  burst_touched_ = false;
  if (!more) dma_[static_cast<std::size_t>(request)].set(false);
}

std::uint32_t Timer::burst_register() {
  return 4 * ((dcr_ & 31) + burst_index_);
}

void Timer::burst_step() {
  burst_touched_ = true;
  if (++burst_index_ > ((dcr_ >> 8) & 31)) burst_index_ = 0;
}

void Timer::clock_changed() {
  sync();
  const Clocks& clocks = chip_.clocks;
  const double timer_clock_Hz = config_.on_apb2 ? clocks.timclk2_Hz() : clocks.timclk1_Hz();
  grid_.set_frequency(timer_clock_Hz, chip_.events.now());
  pattern_dirty_ = true;
  settle();
}

}  // namespace whirl::stm32
