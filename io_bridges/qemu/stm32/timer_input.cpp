// The input side of a timer: filters, capture, the slave mode controller, encoder, ETR and break.
#include <algorithm>
#include <utility>

#include "io_bridges/qemu/stm32/register_access.hpp"
#include "io_bridges/qemu/stm32/timer.hpp"

namespace whirl::stm32 {

using namespace tim;

namespace {

// TS values.
constexpr unsigned kTi1Edges = 4, kTi1Filtered = 5, kTi2Filtered = 6, kEtr = 7;

struct Filter {
  int clocks_per_sample;  // times CK_INT below 4, times t_DTS from there on
  int samples;
};
constexpr Filter kFilters[16] = {{1, 0},  {1, 2},  {1, 4},  {1, 8}, {2, 6},  {2, 8},
                                 {4, 6},  {4, 8},  {8, 6},  {8, 8}, {16, 5}, {16, 6},
                                 {16, 8}, {32, 5}, {32, 6}, {32, 8}};

}  // namespace

// A level passes the filter once it has held for as many samples as ICxF asks for.
Nanoseconds Timer::filter_time_ns(int ti) const {
  const std::uint32_t selected = is_output(ti) ? 0 : ccmr(ti) >> 4;
  const Filter& filter = kFilters[selected];
  if (filter.samples == 0 || grid_.frequency_Hz() == 0) return 0;
  const std::int64_t dts = selected < 4 ? 1 : std::int64_t{1} << std::min(field(cr1_, 8, 2), 2u);
  const std::int64_t clocks = filter.clocks_per_sample * filter.samples * dts;
  return clocks * 1'000'000'000 / grid_.frequency_Hz();
}

void Timer::raw_changed(int ti) {
  bool level = pins_[ti]->level();
  if (ti == 0 && (cr2_ & TI1S) != 0) {
    level = pins_[0]->level() != (pins_[1]->level() != pins_[2]->level());
  }
  Input& input = input_[ti];
  if (level == input.raw) return;
  input.raw = level;
  const Nanoseconds time_ns = filter_time_ns(ti);
  if (settling_ && slave_mode() != 0) {  // our own output, on its way out
    const Nanoseconds due = behind_synchroniser();
    if (due != io::kNever) input.filter->at(due);
  } else if (time_ns == 0) {
    filtered_edge(ti);
  } else if (level == input.level) {
    input.filter->cancel();
  } else {
    input.filter->in(time_ns);
  }
}

void Timer::filtered_edge(int ti) {
  Input& input = input_[ti];
  if (input.level == input.raw) return;
  input.level = input.raw;
  sync();
  for (int ch = 0; ch < can_.channels; ++ch) {
    const std::uint32_t selection = ccmr(ch) & 3;
    const bool selected = (selection == 1 && ti == ch) || (selection == 2 && ti == (ch ^ 1));
    if (selected && edge_counts(ch, input.level)) capture(ch);
  }
  if (ti == 0) {
    trigger_source_edge(kTi1Edges, true);
    trigger_source_edge(kTi1Edges, false);
    trigger_source_edge(kTi1Filtered, polarised(0, 0, input.level));
  }
  if (ti == 1) trigger_source_edge(kTi2Filtered, polarised(1, 1, input.level));
  if (ti < 2 && encoder()) encoder_edge(ti);
  settle();
}

bool Timer::edge_counts(int ch, bool level) const {
  const std::uint32_t polarity = ccer_ >> (4 * ch);
  if (bit(polarity, 1) && bit(polarity, 3) && config_.both_edges) return true;
  return level != bit(polarity, 1);
}

// TIxFPy as a level: the input after channel y's polarity.
bool Timer::polarised(int /*ti*/, int ch, bool level) const {
  return level != bit(ccer_, 4 * ch + 1);
}

void Timer::capture(int ch) {
  if (!bit(ccer_, 4 * static_cast<unsigned>(ch))) return;
  Channel& c = channel_[ch];
  const unsigned every = 1u << field(ccmr(ch), 2, 2);
  if (++c.captures < every) return;
  c.captures = 0;
  c.ccr = cnt_;
  if ((sr_ & (CC1IF << ch)) != 0) sr_ |= CC1OF << ch;
  sr_ |= CC1IF << ch;
  if ((dier_ & (CC1DE << ch)) != 0) raise(ch + 1);
  if (ch == 0 && master_mode() == 3) ++pulses_;
  compare_[ch].pulse(chip_.events.now());
}

bool Timer::captures_trc() const {
  for (int ch = 0; ch < can_.channels; ++ch) {
    if ((ccmr(ch) & 3) == 3) return true;
  }
  return false;
}

void Timer::capture_on_trc() {
  for (int ch = 0; ch < can_.channels; ++ch) {
    if ((ccmr(ch) & 3) == 3) capture(ch);
  }
}

void Timer::connect_itr(int n, TriggerLine& master) {
  itr_[n] = &master;
  itr_handle_[n] = master.add_sink([this, n](bool level, Nanoseconds) {
    if (settling_) return hear_later(static_cast<unsigned>(n), level);
    sync();
    trigger_source_edge(static_cast<unsigned>(n), level);
    settle();
  });
}

// Timers in a ring reset each other: our own edge comes back while it is still going out. On the part
// each hop takes the clocks of its synchroniser, so the ring swings; here that keeps it from going
// round for ever at one instant.
Nanoseconds Timer::behind_synchroniser() const {
  return grid_.time(grid_.ticks(chip_.events.now()) + kSynchroniser_clocks);
}

void Timer::hear_later(unsigned source, bool level) {
  const Nanoseconds due = behind_synchroniser();
  if (due == io::kNever) return;  // without a clock nothing gets through
  late_edges_.push_back({source, level});
  if (!resynchronised_.pending()) resynchronised_.at(due);
}

void Timer::hear_late_edges() {
  sync();
  for (const auto& [source, level] : std::exchange(late_edges_, {})) {
    trigger_source_edge(source, level);
  }
  settle();
}

// Listens to the master that TS selects, as far as anything here hears it.
void Timer::select_trigger() {
  const unsigned selected = field(smcr_, 4, 3);
  const bool heard = can_.slave && (slave_mode() >= 4 || captures_trc());
  for (unsigned n = 0; n < itr_.size(); ++n) {
    if (itr_[n] != nullptr) itr_[n]->listen(itr_handle_[n], heard && selected == n);
  }
  gate_ = trigger_level();
}

bool Timer::trigger_level() const {
  const unsigned selected = field(smcr_, 4, 3);
  if (selected < kTi1Edges) return itr_[selected] != nullptr && itr_[selected]->level();
  if (selected == kTi1Filtered) return polarised(0, 0, input_[0].level);
  if (selected == kTi2Filtered) return polarised(1, 1, input_[1].level);
  return selected == kEtr && etr_level_;
}

void Timer::trigger_source_edge(unsigned source, bool level) {
  if (!can_.slave || source != field(smcr_, 4, 3)) return;
  if (level && source <= kTi1Edges) capture_on_trc();
  trigger_edge(level);
}

void Timer::set_trigger_flag() {
  sr_ |= TIF;
  if ((dier_ & TDE) != 0) raise(kTrigger);
}

void Timer::trigger_edge(bool level) {
  const unsigned mode = slave_mode();
  if (mode < 4) return;
  if (mode == 5) {
    if (level != gate_) set_trigger_flag();
    gate_ = level;
    pattern_dirty_ = true;
    return;
  }
  if (!level) return;
  set_trigger_flag();
  if (can_.advanced && (cr2_ & CCUS) != 0 && (cr2_ & CCPC) != 0) com_event();
  if (mode == 4) restart_count();
  if (mode == 6) enable();
  if (mode == 7) step_once();
}

// RM0090 table "Counting direction versus encoder signals".
void Timer::encoder_edge(int ti) {
  const unsigned mode = slave_mode();
  if ((mode == 1 && ti != 1) || (mode == 2 && ti != 0)) return;
  const bool a = polarised(0, 0, input_[0].level);
  const bool b = polarised(1, 1, input_[1].level);
  down_ = ti == 0 ? a == b : a != b;
  step_once();
}

void Timer::etr_changed(bool level) {
  sync();
  const bool active = level != ((smcr_ & ETP) != 0);
  const unsigned every = 1u << field(smcr_, 12, 2);
  if (active && ++etr_edges_ >= every) {
    etr_edges_ = 0;
    if ((smcr_ & ECE) != 0) step_once();
    trigger_source_edge(kEtr, true);
    if (every > 1) trigger_source_edge(kEtr, false);
  } else if (!active && every == 1) {
    trigger_source_edge(kEtr, false);
  }
  etr_level_ = active;
  settle();
}

bool Timer::break_active() const {
  return (bdtr_ & BKE) != 0 && break_.routed() && break_.level() == ((bdtr_ & BKP) != 0);
}

void Timer::break_changed() {
  if (!break_active()) return;
  sync();
  break_now();
  settle();
}

void Timer::break_now() {
  sr_ |= BIF;
  bdtr_ &= ~MOE;
  pattern_dirty_ = true;
}

}  // namespace whirl::stm32
