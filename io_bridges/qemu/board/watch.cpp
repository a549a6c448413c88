#include "io_bridges/qemu/board/watch.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace whirl::board {
namespace {

constexpr std::uint32_t kBasicFrame = 0x20, kFloatingFrame = 0x68;

// What a function returns by, as a branch leaves it in PC.
std::uint32_t return_address(std::uint32_t lr) {
  return lr >= kExc_return ? lr : lr & ~1u;
}

// Where the core has stacked what ran at `before`.
std::uint32_t frame_of(const CoreState& before, const CoreState& after) {
  const std::uint32_t size = has_floating_frame(after.lr) ? kFloatingFrame : kBasicFrame;
  return (before.sp - size) & ~7u;
}

}  // namespace

std::array<Nanoseconds, Watch::kExceptions> Watch::filled() {
  std::array<Nanoseconds, kExceptions> values{};
  values.fill(kNever);
  return values;
}

void Watch::core_was_reset() {
  tasks_.clear();
  handlers_.clear();
  stacks_.reset();
  raised_ns_ = filled();
}

void Watch::run_ends(Nanoseconds now) {
  for (const auto* contexts : {&tasks_, &handlers_}) {
    for (const Context& context : *contexts) {
      for (const Call& call : context.calls) {
        happened_.add(io::Kind::function_call, call.number, now,
                      io::FunctionCall{call.entry_ns, -1, context.latency_ns, -1, -1});
      }
    }
  }
}

Watch::Context& Watch::running() {
  if (!handlers_.empty()) return handlers_.back();
  if (tasks_.size() <= stacks_.current()) tasks_.resize(stacks_.current() + 1);
  return tasks_[stacks_.current()];
}

void Watch::run_until(const CoreState& core) {
  Spent& ran = running().ran;
  ran.ns += core.now - counted_until_.ns;
  ran.cycles += core.cycles - counted_until_.cycles;
  counted_until_ = {core.now, core.cycles};
}

// Where thread mode is; if it loaded its stack pointer on the way, the time since then is of the stack
// that it loaded. What ran until the load has been counted with it.
void Watch::see(const CoreState& core) {
  if (handlers_.empty()) {
    const Load load = std::exchange(load_, Load::none);
    if (load == Load::none) {
      stacks_.ran_on(core.sp);
    } else {
      stacks_.loaded(core.sp, load == Load::from_memory);
    }
  }
  run_until(core);
}

// `returns_to` 0: its handler ended without it.
void Watch::finish(const Context& context, const Call& call, const CoreState& core,
                   std::uint32_t returns_to) {
  LongCall done;
  done.entry_ns = call.entry_ns;
  done.return_ns = core.now;
  done.execution = {context.ran.ns - call.ran_before.ns,
                    context.ran.cycles - call.ran_before.cycles};
  done.response = {core.now - call.entry_ns, core.cycles - call.entry_cycles};
  done.exception = context.exception;
  happened_.add(io::Kind::function_call, call.number, core.now,
                io::FunctionCall{call.entry_ns, done.execution.ns, context.latency_ns,
                                 static_cast<std::int64_t>(done.execution.cycles),
                                 static_cast<std::int64_t>(done.response.cycles)});
  const auto path = [&] {
    return path_ && returns_to != 0 ? path_(returns_to, core) : std::string();
  };
  // By reference: a std::function of what it captures would be allocated at each return.
  worst_.returned(call.number, std::move(done), call.exceptions_before, std::cref(path));
}

void Watch::enter_function(std::uint16_t number, const CoreState& core) {
  see(core);
  Context& context = running();
  const Call call{number, return_address(core.lr), core.sp, core.now, core.cycles, context.ran,
                  loads_, worst_.exceptions()};
  const auto known = std::find_if(context.calls.begin(), context.calls.end(), [&](const Call& c) {
    return c.return_address == call.return_address && c.sp == call.sp && c.number == number;
  });
  if (known != context.calls.end() && known->loads_before == loads_) return;
  if (known != context.calls.end()) context.calls.erase(known);
  if (context.calls.size() == kDeepest) context.calls.erase(context.calls.begin());
  context.calls.push_back(call);
}

void Watch::return_site(std::uint32_t address, const CoreState& core) {
  see(core);
  Context& context = running();
  for (std::size_t i = context.calls.size(); i-- > 0;) {
    const Call call = context.calls[i];
    if (call.return_address != address || call.sp != core.sp) continue;
    context.calls.erase(context.calls.begin() + static_cast<std::ptrdiff_t>(i));
    finish(context, call, core, address);
  }
}

void Watch::stack_pointer_loads(const CoreState& core, bool may_be_new) {
  see(core);
  load_ = may_be_new ? Load::from_memory : Load::by_move;
  ++loads_;
}

bool Watch::exception(const CoreState& before, const CoreState& after) {
  see(before);
  counted_until_ = {after.now, after.cycles};
  if (before.leaves_exception()) {
    leave(before);
    return arrive(after);
  }
  if (after.exception() == before.exception()) return false;  // none was taken
  if (handlers_.empty()) stacks_.interrupted(before.sp, frame_of(before, after));
  enter(after);
  return true;
}

void Watch::enter(const CoreState& core) {
  Context& entered = handlers_.emplace_back();
  entered.exception = core.exception();
  taken_[core.exception() % kExceptions] = true;
  entered.entered_ns = core.now;
  entered.latency_ns = take_latency(core);
}

void Watch::leave(const CoreState& core) {
  if (handlers_.empty()) return;
  const Context& left = handlers_.back();
  for (std::size_t i = left.calls.size(); i-- > 0;) finish(left, left.calls[i], core, 0);
  worst_.exception_ended(left.exception, left.entered_ns, left.ran);
  handlers_.pop_back();
}

// Behind an exception that was left: the handler or the task below, or the next exception at once.
bool Watch::arrive(const CoreState& after) {
  const auto active = std::find_if(handlers_.rbegin(), handlers_.rend(), [&](const Context& c) {
    return c.exception == after.exception();
  });
  if (after.exception() != 0 && active == handlers_.rend()) {
    enter(after);
    return true;
  }
  while (!handlers_.empty() && handlers_.back().exception != after.exception()) leave(after);
  if (handlers_.empty()) stacks_.resumed(after.sp);
  return false;
}

Nanoseconds Watch::take_latency(const CoreState& core) {
  const std::uint32_t exception = core.exception();
  if (exception >= kExceptions || raised_ns_[exception] < 0) return kNever;
  Nanoseconds& raised_ns = raised_ns_[exception];
  happened_.add(io::Kind::interrupt_latency, static_cast<std::uint16_t>(exception), core.now,
                io::InterruptLatency{raised_ns});
  return core.now - std::exchange(raised_ns, kNever);
}

void Watch::line_changed(std::uint32_t exception, bool level, Nanoseconds now) {
  if (exception >= kExceptions) return;
  Nanoseconds& raised_ns = raised_ns_[exception];
  if (!level) raised_ns = kNever;  // served by polling, or the handler is already running
  if (level && raised_ns < 0) raised_ns = now;
}

}  // namespace whirl::board
