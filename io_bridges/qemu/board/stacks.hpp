// The stacks that thread mode runs on, told apart by the stack pointer alone: one for each task of an
// RTOS, one for an image without.
//
//   Same      an exception returned to the stack pointer that it interrupted, or to its frame (an
//             RTOS that leaves the frame in place for later)
//   Switch    it returned to where another stack was left, or into the range that one has used; in
//             thread mode the same after an instruction that loads the stack pointer
//   New       any other place. A MOV to the stack pointer makes none: that is how compilers allocate
//             arrays of variable length
//   Used      from the highest stack pointer seen down to the deepest byte that has changed since;
//             512 unchanged bytes are taken for the end, whatever was or was not written below
//   Bound     after 64 stacks the nearest one is taken
//   Left out  a stack that thread mode enters by MSR begins where it is first seen: a few bytes short
#pragma once
#include <cstdint>
#include <vector>

#include "io_bridges/qemu/board/post_mortem.hpp"

namespace whirl::board {

struct StackUse {
  std::uint32_t top = 0;
  std::uint32_t used_bytes = 0;
};

class Stacks {
 public:
  explicit Stacks(Peek peek) : peek_(std::move(peek)) {}

  void reset() { stacks_.clear(); }
  std::size_t current() const { return current_; }
  std::size_t count() const { return stacks_.size(); }

  // Thread mode is seen at `sp`.
  void ran_on(std::uint32_t sp);                            // on the stack that it was on
  void loaded(std::uint32_t sp, bool may_be_new);           // the stack pointer has been loaded
  void interrupted(std::uint32_t sp, std::uint32_t frame);  // an exception stacked from there
  void resumed(std::uint32_t sp);                           // by an exception's return

  // Of the stacks that an RTOS made: all but the first one after reset.
  std::vector<StackUse> task_stacks() const;

 private:
  struct Stack {
    std::uint32_t low = 0, high = 0;       // stack pointers seen
    std::uint32_t left_at = 0, frame = 0;  // by the last exception that interrupted it
    std::vector<std::uint8_t> before;      // what was below `high` when the stack was new
  };

  void go_to(std::size_t stack, std::uint32_t sp);
  void add(std::uint32_t sp);
  // The stack whose range contains `sp`, the current one first; count(): none.
  std::size_t containing(std::uint32_t sp) const;
  std::size_t nearest(std::uint32_t sp) const;
  StackUse use_of(const Stack& stack) const;

  Peek peek_;
  std::vector<Stack> stacks_;
  std::size_t current_ = 0;
};

}  // namespace whirl::board
