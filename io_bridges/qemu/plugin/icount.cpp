// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/icount.hpp"

#include <dlfcn.h>

#include <cstring>

namespace whirl::qemu {

Result<Done> InstructionCount::find_timers() {
  timers_ = static_cast<const std::int64_t*>(dlsym(RTLD_DEFAULT, "timers_state"));
  if (timers_ != nullptr) return Done{};
  return whirl::Error{ErrorKind::host, "QEMU", "it does not export timers_state",
                      std::string("use QEMU ") + tested_versions()};
}

// CPUState keeps a pointer to its environment beside one to the decrementer: these differ by what
// translated code uses. Around the budget lie -1 (no flags for the next block), a request, 0, and then
// the two numbers of the budget.
bool InstructionCount::find_budget(Cpu* cpu, std::intptr_t decrementer) {
  constexpr int kSearched = 2048;
  constexpr std::uint32_t kNo_flags = 0xFFFFFFFFu, kMost_requests = 0x1000;
  constexpr std::int64_t kMost_low = 0xFFFF;
  char* const base = reinterpret_cast<char*>(cpu);
  const auto word = [base](int at) {
    std::int64_t value = 0;
    std::memcpy(&value, base + at, sizeof value);
    return value;
  };
  for (int at = 0; at < kSearched; at += 8) {
    if (low_ == nullptr && word(at) != 0 && word(at + 8) == word(at) + decrementer) {
      low_ = reinterpret_cast<std::uint16_t*>(word(at + 8));
    }
    const std::int64_t given = word(at + 16), extra = word(at + 24);
    for (const int shift : {0, 4}) {
      auto* flags = reinterpret_cast<std::uint32_t*>(base + at + shift);
      const bool like_it = flags[0] == kNo_flags && flags[1] < kMost_requests && flags[2] == 0 &&
                           given > 0 && extra >= 0 && extra <= given && given - extra <= kMost_low;
      if (budget_ != nullptr || !like_it) continue;
      next_flags_ = flags;
      budget_ = reinterpret_cast<std::int64_t*>(base + at + 16);
    }
  }
  return low_ != nullptr && budget_ != nullptr;
}

}  // namespace whirl::qemu
