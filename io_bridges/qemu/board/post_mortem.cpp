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

void add(std::string& text, const Image& image, std::uint32_t address) {
  if (!text.empty()) text += '\n';
  text += image.describe(address);
}

}  // namespace

std::string backtrace(const Image& image, const Peek& peek, std::uint32_t pc, std::uint32_t lr,
                      std::uint32_t sp) {
  std::string text;
  add(text, image, pc);
  int frames = 1;
  const auto is_code = [&](std::uint32_t word) {
    return (word & 1u) != 0 && image.function_at(word - 3) != nullptr &&
           behind_a_call(peek, word & ~1u);
  };
  if (is_code(lr)) {
    add(text, image, lr - 3);
    ++frames;
  }
  for (std::uint32_t at = sp; at < sp + kSearch && frames < kFrames; at += 4) {
    std::uint32_t word = 0;
    if (!peek(at, &word, sizeof word)) break;
    if (!is_code(word) || word == lr) continue;
    add(text, image, word - 3);  // an address within the call
    ++frames;
  }
  return text;
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
