// SPDX-License-Identifier: GPL-2.0-or-later
//
// How the core's time passes, and what time it is for the core. QEMU's virtual clock drives all events;
// the core may be ahead of it by a part of an instruction.
//
//   fixed_rate   so many nanoseconds for each instruction
//   cycle_clock  so many cycles of HCLK as the core takes
#pragma once
#include <cstdint>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/qemu/board/core_timing.hpp"
#include "io_bridges/qemu/board/watch.hpp"
#include "io_bridges/qemu/plugin/plugin_api.hpp"

namespace whirl::qemu {

using io::Nanoseconds;

struct Moment {
  Nanoseconds now = 0;
  std::uint64_t cycles = 0;  // of HCLK since power-on
};

class CoreClock {
 public:
  virtual ~CoreClock() = default;
  virtual Result<Done> find_qemu() = 0;  // what of QEMU's inside it needs

  // A block is being translated; `sites` numbers the instructions at which at() will be asked.
  // Returns for each what at() needs to know of it.
  virtual std::vector<std::int64_t> translated(qemu_plugin_tb* block,
                                               const std::vector<std::uint32_t>& sites) = 0;
  virtual void code_thrown_away() = 0;
  // Asked when a block is translated: may it be a part of one, which the clock wanted done by itself?
  virtual bool asked_for_part() { return false; }
  // Before that instruction, in the middle of translated code.
  virtual Moment at(std::int64_t site) const = 0;

  // Before QEMU's clock is read: it goes to the core's time, as far as no deadline lies before that.
  virtual void settle() {}
  // Where QEMU's clock may be read, which shows `now`.
  virtual void anchor(Nanoseconds now) = 0;
  virtual Nanoseconds core_now() const = 0;       // as of the last anchor
  virtual double ahead_ns() const = 0;            // of QEMU's clock, as of the last anchor
  virtual std::uint64_t core_cycles() const = 0;  // of HCLK since power-on, as of the last anchor
  Moment moment() const { return {core_now(), core_cycles()}; }

  virtual void exception(const board::CoreState& before, const board::CoreState& after,
                         std::uint32_t fpccr) = 0;
  virtual void accessed(std::uint32_t address, bool write) = 0;
  // The instruction at `pc` has come to a register. True: what holds it should be translated anew.
  virtual bool reached_register(std::uint32_t /*pc*/) { return false; }
  // The core halted while QEMU's clock showed `from`, and goes on at `to`. Returns how long it slept.
  virtual Nanoseconds slept(Nanoseconds from, Nanoseconds to) = 0;
  // True: what has been translated no longer holds.
  virtual bool retime(const board::CoreTiming& timing) = 0;
};

}  // namespace whirl::qemu
