// SPDX-License-Identifier: GPL-2.0-or-later
//
// Puts the time that a block takes into the block's own translated code.
//
//   Budget    QEMU takes a block's length (1 ns an instruction) off its budget at the block's start, if
//             that lasts. There `debt` is taken off too, which holds what the block costs beyond that;
//             what the budget cannot pay stays in `debt`. So no deadline is passed unseen, and the core
//             is ahead of QEMU's clock by `debt`. The budget comes in pieces of 65,535 ns, filled up at
//             moments that are none of the guest's: nothing may hang on these. So a debt that only the piece
//             at hand was too short for is paid before the clock is read (settle()), and one below 0 waits:
//             a piece that is full has no room for it
//   Registers QEMU leaves a block before an access that turns out to reach a register, and does it again
//             as a block of its own. So the cost of a load or store, and of what follows it, is counted
//             behind it only
//   Branches  a taken one pays its refill on the way out, and the next block what its first line of
//             flash takes (`entered`)
//   Deadline  a block that the budget would not last for is left at its start and done again, cut off
//             at the instruction in which the deadline falls: too_short()
//   Operands  are paid for ahead of what computes with them (operand_cost.hpp)
//   Addresses ahead of the access: data in flash, and what is unaligned (access_cost.hpp)
//   Lines     of the F405's cache (fetch_model.hpp) are looked up in line, without a branch
//   Repeats   an instruction that has been seen to reach registers is not begun in the middle of a block
//             if it does so again: the block is left ahead of it, as QEMU would leave it halfway
//   Unit      2^-16 ns
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "io_bridges/qemu/cycles/fetch_model.hpp"
#include "io_bridges/qemu/plugin/access_cost.hpp"
#include "io_bridges/qemu/plugin/icount.hpp"
#include "io_bridges/qemu/plugin/plugin_api.hpp"

namespace whirl::qemu {

constexpr int kUnit_shift = 16;  // of a ns: 39 hours fit
constexpr std::int64_t kUnits_per_ns = std::int64_t{1} << kUnit_shift;

// What one block costs, in units.
struct BlockCost {
  std::vector<std::int64_t> each;  // instruction, without what is known at run time only
  std::int64_t taken = 0;          // when its last branch is
  std::int64_t entry = 0;          // when it is reached by a taken branch
  struct Line {
    std::uint32_t number;
    std::int64_t missed;
  };
  std::vector<Line> lines;
  std::int64_t cycle = 0;
  std::int64_t lazy_frame = 0;  // when the FPU's registers are saved late
  std::int64_t flash_wait = 0;  // when data comes from flash; with its cache: when it is not held
  bool data_cache = false;
  struct Kind {
    bool memory;            // loads or stores
    int leads_to_register;  // core register that has led it to registers of the part; -1: none
    bool reads_flash;       // may, and `each` has not counted it
    bool unaligned;         // may be
    bool long_multiply;     // whose cycles go by its operands
  };
  std::vector<Kind> kinds;             // of each instruction
  std::vector<std::uint32_t> offsets;  // of each from the block's start, bytes
  bool ends_in_branch = false;
};

class CostInjection {
 public:
  // `refuse` ends the run: QEMU's inside is not what it is in 7.2.
  CostInjection(const Api& api, std::function<void()> refuse)
      : api_(api), refuse_(std::move(refuse)) {}

  Result<Done> find_qemu();
  void put(qemu_plugin_tb* block, const BlockCost& cost, bool keep_stalls);
  // What has been counted at instruction `n` of such a block, less what those before it cost.
  static std::int64_t ahead_at(const BlockCost& cost, std::size_t n);
  void code_thrown_away() { blocks_.clear(); }
  bool asked_for_part() { return std::exchange(asked_for_part_, false); }
  void forget_code_lines() { state_.code.forget(); }
  void forget_data_lines() { state_.data.forget(); }

  const InstructionCount& count() const { return count_; }
  void settle();
  std::int64_t debt() const { return state_.debt; }
  void owe(std::int64_t units) { state_.debt += units; }
  void set_debt(std::int64_t units) { state_.debt = units; }
  void refetch() { state_.entered = -1; }  // execution goes on elsewhere: by an exception
  std::int64_t stalled() const { return state_.stalled; }

 private:
  struct State {  // written by translated code
    std::int64_t debt = 0;
    std::int64_t entered = 0;  // -1: the last block ended in a taken branch
    std::int64_t stalled = 0;  // what lines and entry cost the last block that keeps it
    FlashLines code{cycles::kCached_lines}, data{cycles::kCached_data_lines};
  };
  struct Block {
    CostInjection* owner;
    std::int64_t charged;  // off the budget at the start, with QEMU's own part
    std::vector<std::int64_t> each;
  };
  class Writer;
  void too_short(const Block& block);
  void find_budget(std::intptr_t decrementer);

  const Api& api_;
  std::function<void()> refuse_;
  InstructionCount count_;
  State state_;
  std::vector<std::unique_ptr<Block>> blocks_;  // translated code points at them
  bool asked_for_part_ = false;                 // since the last block was translated
};

}  // namespace whirl::qemu
