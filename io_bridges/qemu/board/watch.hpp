// Watches an image that knows nothing of it: functions, exceptions and their latency, from a few
// instrumented instructions.
//
//   In        told by the plug-in: entry of a watched function, arrival at an address to which one
//             returns, first instruction of an exception handler, an instruction that may leave one
//   Returns   a call ends where its link register said, with the stack pointer of its entry; a tail
//             call counts for the caller. A handler's own call ends with the handler.
//   Execution of a call: its time less that of the exceptions that came on top of it
//   Latency   of an exception: from the request of its line to the first instruction of its handler,
//             without the twelve cycles that the core itself takes to stack; it goes with each call
//             that the handler makes
//   Leaving   the last instruction that could leave a handler is the one that did: known when
//             anything happens in another context
//   Loops     a handler that jumps to its own first instruction ("b .") has not been entered again
//   Left out  tasks switched by an RTOS: execution of a call then includes the other tasks'
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/link/messages.hpp"

namespace whirl::board {

using io::Nanoseconds;

// The core as of the start of a basic block.
struct CoreState {
  Nanoseconds now = 0;
  std::uint32_t exception = 0;  // IPSR: 0 in thread mode
  std::uint32_t sp = 0, lr = 0;
};

class Watch {
 public:
  explicit Watch(io::Batch& happened) : happened_(happened) { contexts_.push_back({}); }

  void enter_function(std::uint16_t number, const CoreState& core);
  void return_site(std::uint32_t address, const CoreState& core);
  // `preempted` is the exception number in the stacked xPSR. False: it was not an entry.
  bool enter_exception(std::uint32_t preempted, const CoreState& core);
  void may_leave_exception(Nanoseconds after);

  void line_changed(std::uint32_t exception, bool level, Nanoseconds now);
  void core_was_reset();

 private:
  static constexpr std::size_t kExceptions = 256, kDeepest = 64;
  struct Context {
    std::uint32_t exception = 0;
    Nanoseconds entered_ns = 0, left_ns = 0;
    Nanoseconds preempted_ns = 0;  // by what came on top
    Nanoseconds latency_ns = -1;   // of its entry; -1: not known
    std::uint32_t sp = 0;          // at entry
    bool may_be_left = false;
  };
  struct Call {
    std::uint16_t number = 0;
    std::uint32_t return_address = 0, sp = 0;
    std::size_t depth = 0;  // of its context
    Nanoseconds entry_ns = 0, preempted_before_ns = 0, latency_ns = -1;
  };

  void settle(std::uint32_t exception);  // drops the contexts that have been left
  void leave_context();
  Nanoseconds take_latency(const CoreState& core);  // and tells it; -1: not known
  void finish(std::size_t call, Nanoseconds now);

  io::Batch& happened_;
  std::vector<Context> contexts_;
  std::vector<Call> calls_;
  std::array<Nanoseconds, kExceptions> raised_ns_ = filled();
  static std::array<Nanoseconds, kExceptions> filled();
};

}  // namespace whirl::board
