#include "io_bridges/qemu/board/stacks.hpp"

#include <algorithm>

namespace whirl::board {
namespace {

constexpr std::size_t kMost = 64;
constexpr std::uint32_t kDeepest = 16 * 1024;  // that the use of a task's stack is looked for

std::uint32_t distance(std::uint32_t low, std::uint32_t high, std::uint32_t sp) {
  return sp < low ? low - sp : sp > high ? sp - high : 0;
}

}  // namespace

std::size_t Stacks::containing(std::uint32_t sp) const {
  const auto holds = [sp](const Stack& s) { return distance(s.low, s.high, sp) == 0; };
  if (holds(stacks_[current_])) return current_;
  const auto found = std::find_if(stacks_.begin(), stacks_.end(), holds);
  return static_cast<std::size_t>(found - stacks_.begin());
}

std::size_t Stacks::nearest(std::uint32_t sp) const {
  const auto closer = [sp](const Stack& a, const Stack& b) {
    return distance(a.low, a.high, sp) < distance(b.low, b.high, sp);
  };
  return static_cast<std::size_t>(std::min_element(stacks_.begin(), stacks_.end(), closer) -
                                  stacks_.begin());
}

void Stacks::add(std::uint32_t sp) {
  current_ = stacks_.size();
  Stack& stack = stacks_.emplace_back();
  stack.low = stack.high = sp;
  for (std::uint32_t size = kDeepest; size >= kStack_gap && stack.before.empty(); size /= 2) {
    stack.before.resize(size);
    if (sp < size || !peek_(sp - size, stack.before.data(), size)) stack.before.clear();
  }
}

void Stacks::go_to(std::size_t stack, std::uint32_t sp) {
  current_ = stack;
  stacks_[stack].low = std::min(stacks_[stack].low, sp);
  stacks_[stack].high = std::max(stacks_[stack].high, sp);
}

void Stacks::ran_on(std::uint32_t sp) {
  if (stacks_.empty()) return add(sp);
  go_to(current_, sp);
}

void Stacks::loaded(std::uint32_t sp, bool may_be_new) {
  if (stacks_.empty()) return add(sp);
  const std::size_t known = containing(sp);
  if (known < count()) return go_to(known, sp);
  if (!may_be_new) return go_to(current_, sp);
  if (count() == kMost) return go_to(nearest(sp), sp);
  add(sp);
}

void Stacks::interrupted(std::uint32_t sp, std::uint32_t frame) {
  ran_on(sp);
  stacks_[current_].left_at = sp;
  stacks_[current_].frame = frame;
  stacks_[current_].low = std::min(stacks_[current_].low, frame);
}

void Stacks::resumed(std::uint32_t sp) {
  if (stacks_.empty()) return add(sp);
  if (sp == stacks_[current_].left_at || sp == stacks_[current_].frame) return;
  const auto left_there = [sp](const Stack& s) { return s.left_at == sp; };
  const auto found = std::find_if(stacks_.begin(), stacks_.end(), left_there);
  if (found == stacks_.end()) return loaded(sp, true);
  go_to(static_cast<std::size_t>(found - stacks_.begin()), sp);
}

StackUse Stacks::use_of(const Stack& stack) const {
  StackUse use{stack.high, stack.high - stack.low};
  std::uint32_t floor = stack.high - std::min<std::uint32_t>(stack.high, kDeepest);
  for (const Stack& other : stacks_) {
    if (other.high < stack.high) floor = std::max(floor, other.high);
  }
  const std::size_t size = std::min<std::size_t>(stack.high - floor, stack.before.size());
  std::vector<std::uint8_t> now(size);
  if (size == 0 || !peek_(stack.high - static_cast<std::uint32_t>(size), now.data(), size))
    return use;
  const std::uint8_t* before = stack.before.data() + (stack.before.size() - size);
  use.used_bytes = std::max(use.used_bytes, touched_below_top(now, before));
  return use;
}

std::vector<StackUse> Stacks::task_stacks() const {
  std::vector<StackUse> uses;
  for (std::size_t i = 1; i < count(); ++i) uses.push_back(use_of(stacks_[i]));
  return uses;
}

}  // namespace whirl::board
