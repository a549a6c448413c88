// Watches an image that knows nothing of it: functions, exceptions and their latency, the stacks of its
// tasks.
//
//   In        told by the plug-in: entry of a watched function, arrival at an address to which one
//             returns, every exception taken and left as the core does it, every instruction of
//             thread mode that loads the stack pointer
//   Contexts  each active exception, and in thread mode each stack (stacks.hpp): time counts for the
//             one that runs, so execution of a call is what its own context ran meanwhile
//   Returns   a call ends where its link register said, with the stack pointer of its entry; a tail
//             call counts for the caller. A handler's own call ends with the handler.
//   Latency   of an exception: from the request of its line to the first instruction of its handler;
//             it goes with each call that the handler makes. What the core takes to enter and to leave
//             counts for no context
//   Again     a function that comes to its first instruction a second time, with the link register and
//             stack pointer of a call that is open, goes on with that call; after a load of the
//             stack pointer (longjmp) it is a new one
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/messages/messages.hpp"
#include "io_bridges/qemu/board/stacks.hpp"
#include "io_bridges/qemu/board/worst_calls.hpp"

namespace whirl::board {

using io::Nanoseconds;

// From here on a value in LR or PC is no address but EXC_RETURN: what a handler returns by (DDI 0403E
// B1.5.8). Its bit 4 is clear where the frame holds the FPU's registers too.
constexpr std::uint32_t kExc_return = 0xFFFFFFE0u;
constexpr bool has_floating_frame(std::uint32_t exc_return) {
  return (exc_return & (1u << 4)) == 0;
}

// The core between two instructions.
struct CoreState {
  Nanoseconds now = 0;
  std::uint32_t xpsr = 0;
  std::uint32_t sp = 0, lr = 0, pc = 0;
  std::uint32_t exception() const { return xpsr & 0x1FFu; }  // IPSR: 0 in thread mode
  std::uint64_t cycles = 0;                                  // of HCLK since power-on
  bool leaves_exception() const { return exception() != 0 && pc >= kExc_return; }
};

class Watch {
 public:
  // How thread mode or a handler got to `address` with this stack pointer; callers, one per line.
  using Path = std::function<std::string(std::uint32_t address, const CoreState& core)>;

  Watch(io::Batch& happened, Peek peek, Path path = {})
      : happened_(happened), stacks_(std::move(peek)), path_(std::move(path)) {}

  void enter_function(std::uint16_t number, const CoreState& core);
  void return_site(std::uint32_t address, const CoreState& core);
  // Thread mode is about to load its stack pointer; `core` is as of the start of that basic block.
  void stack_pointer_loads(const CoreState& core, bool may_be_new);
  // The core took or left an exception. True: it took one, maybe behind the one that it left.
  bool exception(const CoreState& before, const CoreState& after);

  void line_changed(std::uint32_t exception, bool level, Nanoseconds now);
  void core_was_reset();
  void run_ends(Nanoseconds now);  // tells the calls that have not returned

  const Stacks& stacks() const { return stacks_; }
  const WorstCalls& worst_calls() const { return worst_; }
  bool was_taken(std::uint32_t exception) const { return taken_[exception % kExceptions]; }
  static constexpr std::size_t kExceptions = 256;

 private:
  static constexpr std::size_t kDeepest = 64;
  static constexpr Nanoseconds kNever = -1;
  struct Call {
    std::uint16_t number = 0;
    std::uint32_t return_address = 0, sp = 0;
    Nanoseconds entry_ns = 0;
    std::uint64_t entry_cycles = 0;
    Spent ran_before;
    std::uint64_t loads_before = 0, exceptions_before = 0;
  };
  struct Context {
    std::uint32_t exception = 0;
    Nanoseconds entered_ns = 0;
    Spent ran;
    Nanoseconds latency_ns = kNever;  // of its entry; kNever: not known
    std::vector<Call> calls;
  };
  enum class Load : std::uint8_t { none, by_move, from_memory };

  Context& running();
  void run_until(const CoreState& core);  // counts for the running context
  void see(const CoreState& core);
  void enter(const CoreState& core);
  void leave(const CoreState& core);
  bool arrive(const CoreState& after);
  Nanoseconds take_latency(const CoreState& core);  // and tells it; kNever: not known
  void finish(const Context& context, const Call& call, const CoreState& core,
              std::uint32_t returns_to);

  io::Batch& happened_;
  Stacks stacks_;
  std::vector<Context> tasks_;     // by number of their stack
  std::vector<Context> handlers_;  // active exceptions, the running one last
  Spent counted_until_;
  WorstCalls worst_;
  Path path_;
  Load load_ = Load::none;  // of the stack pointer, not yet seen where to
  std::uint64_t loads_ = 0;
  std::array<Nanoseconds, kExceptions> raised_ns_ = filled();
  std::array<bool, kExceptions> taken_{};
  static std::array<Nanoseconds, kExceptions> filled();
};

}  // namespace whirl::board
