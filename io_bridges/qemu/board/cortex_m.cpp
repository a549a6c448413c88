#include "io_bridges/qemu/board/cortex_m.hpp"

#include <cmath>

namespace whirl::board {
namespace {

constexpr std::uint32_t kCsr = 0x0, kRvr = 0x4, kCvr = 0x8, kCalib = 0xC;
constexpr std::uint32_t kEnable = 1u << 0, kTickInt = 1u << 1, kClkSource = 1u << 2,
                        kCountFlag = 1u << 16;
constexpr std::uint32_t kDwtCtrl = 0x0, kDwtCyccnt = 0x4;
constexpr double kRounding = 1e-3;  // of a tick, in the core's time
constexpr std::uint32_t kFourComparators = 4u << 28;

}  // namespace

SysTick::SysTick(io::EventQueue& events, const stm32::Clocks& clocks,
                 std::function<double()> ahead_ns, std::function<void()> pend)
    : events_(events),
      clocks_(clocks),
      ahead_ns_(std::move(ahead_ns)),
      pend_(std::move(pend)),
      wrap_(events, [this] { wrap(); }) {}

double SysTick::frequency_Hz() const {
  return (control_ & kClkSource) != 0 ? clocks_.hclk_Hz() : clocks_.hclk_Hz() / 8.0;
}

void SysTick::reset() {
  wrap_.cancel();
  control_ = reload_ = frozen_ = 0;
  flag_ = false;
}

std::uint32_t SysTick::current() const {
  if ((control_ & kEnable) == 0 || anchor_Hz_ <= 0.0) return frozen_;
  const double now_ns = static_cast<double>(events_.now()) + ahead_ns_();
  const double ticks = (now_ns - anchor_ns_) * 1e-9 * anchor_Hz_;
  const double left = to_first_wrap_ + static_cast<double>(wraps_) * (reload_ + 1.0) - ticks;
  // `left` ticks to the next wrap: the counter reads that, and 0 in the last tick is the wrap itself.
  const double value = std::ceil(left - kRounding);
  if (value <= 0.0) return reload_;
  return value > reload_ + 1.0 && wraps_ > 0 ? reload_
                                             : static_cast<std::uint32_t>(value) & 0xFFFFFFu;
}

void SysTick::start_from(std::uint32_t value) {
  anchor_ns_ = static_cast<double>(events_.now()) + ahead_ns_();
  anchor_Hz_ = frequency_Hz();
  wraps_ = 0;
  // From 0 the next tick loads RVR; COUNTFLAG rises when 1 goes to 0 (B3.3.1).
  to_first_wrap_ = value == 0 ? reload_ + 1.0 : value;
  schedule();
}

void SysTick::schedule() {
  if ((control_ & kEnable) == 0 || reload_ == 0 || anchor_Hz_ <= 0.0) return wrap_.cancel();
  const double ticks = to_first_wrap_ + static_cast<double>(wraps_) * (reload_ + 1.0);
  wrap_.at(static_cast<Nanoseconds>(std::llround(anchor_ns_ + ticks / anchor_Hz_ * 1e9)));
}

void SysTick::wrap() {
  flag_ = true;
  ++wraps_;
  if ((control_ & kTickInt) != 0) pend_();
  schedule();
}

void SysTick::clocks_changed() {
  if ((control_ & kEnable) != 0) start_from(current());
}

std::uint32_t SysTick::read(std::uint32_t offset, unsigned /*size*/) {
  switch (offset) {
    case kCsr: {
      const std::uint32_t value = control_ | (flag_ ? kCountFlag : 0);
      flag_ = false;
      return value;
    }
    case kRvr:
      return reload_;
    case kCvr:
      return current();
    case kCalib:
      return 0x40000000u | 18750u;  // SKEW, TENMS as RM0090 12.1.3 gives it
    default:
      return 0;
  }
}

void SysTick::write(std::uint32_t offset, std::uint32_t value, unsigned /*size*/) {
  if (offset == kRvr) {
    const std::uint32_t now = current();
    reload_ = value & 0xFFFFFFu;  // takes effect at the next wrap; until then the count goes on
    if ((control_ & kEnable) != 0) start_from(now);
  } else if (offset == kCvr) {
    frozen_ = 0;  // any write clears the counter and COUNTFLAG
    flag_ = false;
    if ((control_ & kEnable) != 0) start_from(0);
  } else if (offset == kCsr) {
    const std::uint32_t old = current();
    const bool was_running = (control_ & kEnable) != 0;
    const bool new_clock = ((control_ ^ value) & kClkSource) != 0;
    control_ = value & (kEnable | kTickInt | kClkSource);
    if ((control_ & kEnable) == 0) {
      frozen_ = old;
      wrap_.cancel();
    } else if (!was_running || new_clock) {
      start_from(old);
    }
  }
}

void CycleCounter::reset() {
  control_ = 0;
  trace_ = false;
  rebase(0);
}

std::uint32_t CycleCounter::count() const {
  return counting() ? base_ + static_cast<std::uint32_t>(cycles_() - base_cycles_) : base_;
}

void CycleCounter::rebase(std::uint32_t value) {
  base_ = value;
  base_cycles_ = cycles_();
}

void CycleCounter::set_trace_enabled(bool on) {
  const std::uint32_t value = count();
  trace_ = on;
  rebase(value);
}

std::uint32_t CycleCounter::read(std::uint32_t offset, unsigned /*size*/) {
  if (offset == kDwtCtrl) return kFourComparators | control_;
  return offset == kDwtCyccnt ? count() : 0;
}

void CycleCounter::write(std::uint32_t offset, std::uint32_t value, unsigned /*size*/) {
  if (offset == kDwtCtrl) {
    const std::uint32_t kept = count();
    control_ = value & 0x0FFFFFFFu;
    rebase(kept);
  } else if (offset == kDwtCyccnt) {
    rebase(value);
  }
}

std::uint32_t StoredWords::read(std::uint32_t offset, unsigned /*size*/) {
  if (offset == 0) return id_;
  return offset / 4 < 4 ? words_[offset / 4] : 0;
}

void StoredWords::write(std::uint32_t offset, std::uint32_t value, unsigned /*size*/) {
  if (offset / 4 < 4) words_[offset / 4] = value;
}

}  // namespace whirl::board
