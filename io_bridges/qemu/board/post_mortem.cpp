#include "io_bridges/qemu/board/post_mortem.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace whirl::board {
namespace {

constexpr int kFrames = 16;
constexpr std::uint32_t kSearch = 2048;  // bytes of stack that a backtrace looks through

bool in(const MemoryBlock& block, std::uint32_t address) {
  return address >= block.base && address - block.base < block.size;
}

// Does an instruction that calls end at `address`? (BL: 32 bits; BLX register: 16 bits)
bool behind_a_call(const Peek& peek, std::uint32_t address) {
  std::uint16_t code[2] = {0, 0};
  if (!peek(address - 4, code, sizeof code)) return false;
  const bool bl = (code[0] & 0xF800) == 0xF000 && (code[1] & 0xD000) == 0xD000;
  const bool blx = (code[1] & 0xFF87) == 0x4780;
  return bl || blx;
}

// Lines of callers, innermost first.
class Callers {
 public:
  Callers(const Image& image, const Peek& peek) : image_(image), peek_(peek) {}

  void add(std::uint32_t address) {
    if (!text_.empty()) text_ += '\n';
    text_ += image_.describe(address);
    ++frames_;
  }
  bool is_return_address(std::uint32_t word) const {
    return (word & 1u) != 0 && image_.function_at(word - 3) != nullptr &&
           behind_a_call(peek_, word & ~1u);
  }
  // Every word up the stack that points behind a call; not `known`, and
  // of a handler no further than to what it interrupted.
  void add_from_stack(std::uint32_t sp, std::uint32_t known, bool to_end_of_handler) {
    for (std::uint32_t at = sp; at < sp + kSearch && frames_ < kFrames; at += 4) {
      std::uint32_t word = 0;
      if (!peek_(at, &word, sizeof word)) break;
      if (to_end_of_handler && is_exc_return(word)) break;
      if (is_return_address(word) && word != known) add(word - 3);  // an address within the call
    }
  }
  const std::string& text() const { return text_; }

 private:
  // The values that there are (DDI 0403E table B1-8): a pushed LR of a handler's first function.
  static bool is_exc_return(std::uint32_t word) {
    const std::uint32_t kind = word | 0x10u;  // with or without the FPU's registers
    return kind == 0xFFFFFFF1u || kind == 0xFFFFFFF9u || kind == 0xFFFFFFFDu;
  }

  const Image& image_;
  const Peek& peek_;
  std::string text_;
  int frames_ = 0;
};

}  // namespace

std::string backtrace(const Image& image, const Peek& peek, std::uint32_t pc, std::uint32_t lr,
                      std::uint32_t sp) {
  Callers callers(image, peek);
  callers.add(pc);
  if (callers.is_return_address(lr)) callers.add(lr - 3);
  callers.add_from_stack(sp, lr, false);
  return callers.text();
}

std::string call_path(const Image& image, const Peek& peek, std::uint32_t return_address,
                      std::uint32_t sp, bool in_handler) {
  Callers callers(image, peek);
  callers.add(return_address - 2);
  callers.add_from_stack(sp, return_address | 1u, in_handler);
  return callers.text();
}

std::uint32_t touched_below_top(std::span<const std::uint8_t> memory, const std::uint8_t* before) {
  std::size_t deepest = memory.size(), untouched = 0;
  for (std::size_t i = memory.size(); i-- > 0 && untouched < kStack_gap;) {
    untouched = memory[i] == before[i] ? untouched + 1 : 0;
    if (untouched == 0) deepest = i;
  }
  return static_cast<std::uint32_t>(memory.size() - deepest);
}

std::uint32_t stack_used(const Part& part, const Peek& peek) {
  std::uint32_t top = 0;
  if (!peek(part.flash.base, &top, sizeof top)) return 0;
  const MemoryBlock& home = in(part.ccm, top - 1) ? part.ccm : part.sram;
  if (!in(home, top - 1)) return 0;
  std::vector<std::uint8_t> memory(top - home.base);
  if (!peek(home.base, memory.data(), memory.size())) return 0;
  const std::vector<std::uint8_t> before(memory.size(), kUntouched);
  return touched_below_top(memory, before.data());
}

}  // namespace whirl::board
