// SPDX-License-Identifier: GPL-2.0-or-later
//
// QEMU's count of instructions, from the inside: how much of its budget is left, and what time it is
// where qemu_clock_get_ns must not be called.
//
//   Unit     one instruction of QEMU's count is 1 ns (-icount shift=0)
//   Budget   QEMU sets `low` (16 bits) and `extra` to what may run until the next deadline; each block
//            takes its length off `low` at its start
//   Checked  where these lie is known by what they hold (CPUState) or of 7.2 (its timers); the clock
//            that they give is compared with QEMU's own wherever that may be read, and the run ends by
//            name where they disagree
//   Source   QEMU 7.2: include/hw/core/cpu.h, softmmu/cpu-timers.c, softmmu/icount.c,
//            accel/tcg/tcg-accel-ops-icount.c
#pragma once
#include <algorithm>
#include <cstdint>

#include "base/result.hpp"
#include "io_bridges/qemu/plugin/qemu_api.hpp"

namespace whirl::qemu {

class InstructionCount {
 public:
  Result<Done> find_timers();
  // While a first slice runs; `decrementer` from the CPU's environment, as translated code has it.
  bool find_budget(Cpu* cpu, std::intptr_t decrementer);
  bool found() const { return low_ != nullptr; }

  // Virtual time of the blocks begun so far, ns.
  std::int64_t now_ns() const { return timers_[kBias] + timers_[kCount] + budget_[0] - left_ns(); }
  std::int64_t left_ns() const { return *low_ + budget_[1]; }
  void set_left_ns(std::int64_t left) {
    budget_[1] = 0;
    *low_ = static_cast<std::uint16_t>(left);
  }
  // Off what QEMU puts into `low` when that is used up; returns how much of it there was.
  std::int64_t take_ns(std::int64_t ns) {
    const std::int64_t taken = std::min(ns, budget_[1]);
    budget_[1] -= taken;
    return taken;
  }
  std::uint16_t* low() const { return low_; }
  std::uint32_t* next_flags() const { return next_flags_; }
  // The next block has that many instructions, whatever is in the cache.
  void limit_next_block(std::uint32_t flags) { *next_flags_ = flags; }

 private:
  static constexpr int kBias = 5, kCount = 8;  // words of TimersState

  const std::int64_t* timers_ = nullptr;
  std::uint16_t* low_ = nullptr;
  std::int64_t* budget_ = nullptr;  // icount_budget, icount_extra
  std::uint32_t* next_flags_ = nullptr;
};

}  // namespace whirl::qemu
