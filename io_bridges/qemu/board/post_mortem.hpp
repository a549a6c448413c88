// What a fault exception left behind: registers, the way there, the stack.
//
//   Backtrace  the faulting instruction, its link register, then every word up the stack that
//              points behind a call instruction: it may name too many frames, never too few
//   Stack      the deepest touched word below the initial stack pointer: RAM starts with a pattern
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io_bridges/link/messages.hpp"
#include "io_bridges/qemu/board/image.hpp"
#include "io_bridges/qemu/board/parts.hpp"

namespace whirl::board {

inline constexpr std::uint8_t kUntouched = 0xA5;  // of RAM at power-up

using Peek = std::function<bool(std::uint32_t address, void* to, std::size_t size)>;

// As the core stacked it at exception entry: r0-r3, r12, lr, pc, xpsr at `frame`.
struct ExceptionFrame {
  std::uint32_t lr = 0, pc = 0, xpsr = 0;
  std::uint32_t sp_before = 0;  // of the interrupted code
};
ExceptionFrame read_frame(const Peek& peek, std::uint32_t frame, std::uint32_t exc_return);

// One frame per line, innermost first.
std::string backtrace(const Image& image, const Peek& peek, std::uint32_t pc, std::uint32_t lr,
                      std::uint32_t sp);

// Bytes used below the initial stack pointer; 0 when the vector table gives no sensible one.
std::uint32_t stack_used(const Part& part, const Peek& peek);

}  // namespace whirl::board
