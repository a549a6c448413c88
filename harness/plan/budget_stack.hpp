// t:budget("stack") { depth = "2 KiB", margin = "10 %" }: how deep a stack went, from power-up to the end of
// the run.
//
//   Measured  by the board, of memory alone, when the run ends: from the top down to the deepest byte that
//             changed since power-up. It costs a run nothing, and is no bound of the deepest there is:
//             a frame that was made and never written to its end counts as far as it was written, and the
//             search ends where 512 bytes lie untouched (board/post_mortem.hpp)
//   Which     without `of` the one that the core starts on, interrupts included; else the RTOS task's stack
//             whose array is so called
//   Refused   where the target offers no watches; a board that told of no such stack is never a pass
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "harness/plan/script.hpp"

namespace whirl::plan {

struct StackBudget {
  std::optional<Limit> depth;
  double margin = 0.0;
  std::string of;           // an RTOS's; empty: the core's first
  std::string name, place;  // "stack", as the plan wrote it with its node
  std::size_t node = 0;
};

StackBudget read_stack_budget(const lua::Table& given, std::size_t node, const std::string& name,
                              const std::string& place);
void judge_stack(Script& script, const StackBudget& budget, std::int64_t to_ns);

}  // namespace whirl::plan
