// What a fault exception left behind: registers, the way there, the stack. And how a call was reached.
//
//   Backtrace  the faulting instruction, its link register, then every word up the stack that
//              points behind a call instruction: it may name too many frames, never too few
//   Stack      the deepest touched word below the initial stack pointer: RAM starts with a pattern
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io_bridges/messages/messages.hpp"
#include "io_bridges/qemu/board/image.hpp"
#include "io_bridges/qemu/board/parts.hpp"

namespace whirl::board {

inline constexpr std::uint8_t kUntouched = 0xA5;  // of RAM at power-up
inline constexpr std::uint32_t kStack_gap =
    512;  // bytes that nobody touched: below them nobody has been

using Peek = std::function<bool(std::uint32_t address, void* to, std::size_t size)>;

// One frame per line, innermost first.
std::string backtrace(const Image& image, const Peek& peek, std::uint32_t pc, std::uint32_t lr,
                      std::uint32_t sp);

// The callers of a function that has just returned there, one per line, innermost first; of a handler's
// function those in the handler.
std::string call_path(const Image& image, const Peek& peek, std::uint32_t return_address,
                      std::uint32_t sp, bool in_handler);

// From the end of `memory`, which a stack grows down from, to its deepest byte that is not as before.
std::uint32_t touched_below_top(std::span<const std::uint8_t> memory, const std::uint8_t* before);

// Bytes used below the initial stack pointer; 0 when the vector table gives no sensible one.
std::uint32_t stack_used(const Part& part, const Peek& peek);

}  // namespace whirl::board
