#include "io_bridges/qemu/board/watch.hpp"

#include <utility>

namespace whirl::board {
namespace {

constexpr std::uint32_t kExcReturn = 0xFFFFFFE0u;  // and above: a handler's link register

}  // namespace

std::array<Nanoseconds, Watch::kExceptions> Watch::filled() {
  std::array<Nanoseconds, kExceptions> values{};
  values.fill(-1);
  return values;
}

void Watch::core_was_reset() {
  contexts_.assign(1, {});
  calls_.clear();
  raised_ns_ = filled();
}

void Watch::finish(std::size_t index, Nanoseconds now) {
  const Call call = calls_[index];
  calls_.erase(calls_.begin() + static_cast<std::ptrdiff_t>(index));
  io::FunctionCall message;
  message.entry_ns = call.entry_ns;
  message.execution_ns =
      now - call.entry_ns - (contexts_[call.depth].preempted_ns - call.preempted_before_ns);
  message.latency_ns = call.latency_ns;
  happened_.add(io::Kind::function_call, call.number, now, message);
}

void Watch::leave_context() {
  const Context left = contexts_.back();
  const std::size_t depth = contexts_.size() - 1;
  for (std::size_t i = calls_.size(); i-- > 0;) {
    if (calls_[i].depth == depth) finish(i, left.left_ns);
  }
  contexts_.pop_back();
  contexts_.back().preempted_ns += left.left_ns - left.entered_ns;
}

void Watch::settle(std::uint32_t exception) {
  while (contexts_.size() > 1 && contexts_.back().exception != exception) leave_context();
}

void Watch::enter_function(std::uint16_t number, const CoreState& core) {
  settle(core.exception);
  const std::uint32_t to = core.lr >= kExcReturn ? core.lr : core.lr & ~1u;
  for (std::size_t i = calls_.size(); i-- > 0;) {  // one that never came back (longjmp)
    if (calls_[i].return_address == to && calls_[i].sp == core.sp && calls_[i].number == number) {
      calls_.erase(calls_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  if (calls_.size() == kDeepest) calls_.erase(calls_.begin());
  const Context& context = contexts_.back();
  calls_.push_back({number, to, core.sp, contexts_.size() - 1, core.now, context.preempted_ns,
                    context.latency_ns});
}

void Watch::return_site(std::uint32_t address, const CoreState& core) {
  if (calls_.empty()) return;
  settle(core.exception);
  for (std::size_t i = calls_.size(); i-- > 0;) {
    if (calls_[i].return_address == address && calls_[i].sp == core.sp) finish(i, core.now);
  }
}

void Watch::may_leave_exception(Nanoseconds after) {
  contexts_.back().left_ns = after;
  contexts_.back().may_be_left = true;
}

bool Watch::enter_exception(std::uint32_t preempted, const CoreState& core) {
  const Context& top = contexts_.back();
  if (top.exception == core.exception && top.sp == core.sp && !top.may_be_left) return false;
  settle(preempted);
  contexts_.push_back({core.exception, core.now, core.now, 0, take_latency(core), core.sp, false});
  return true;
}

Nanoseconds Watch::take_latency(const CoreState& core) {
  if (core.exception >= kExceptions || raised_ns_[core.exception] < 0) return -1;
  Nanoseconds& raised_ns = raised_ns_[core.exception];
  happened_.add(io::Kind::interrupt_latency, static_cast<std::uint16_t>(core.exception), core.now,
                io::InterruptLatency{raised_ns});
  return core.now - std::exchange(raised_ns, -1);
}

void Watch::line_changed(std::uint32_t exception, bool level, Nanoseconds now) {
  if (exception >= kExceptions) return;
  Nanoseconds& raised_ns = raised_ns_[exception];
  if (!level) raised_ns = -1;  // served by polling, or the handler is already running
  if (level && raised_ns < 0) raised_ns = now;
}

}  // namespace whirl::board
