#include "io_bridges/qemu/cycles/fetch_model.hpp"

#include <algorithm>

namespace whirl::cycles {
namespace {

constexpr std::uint32_t kEnd_of_flash = 0x10000000;
constexpr double kShared_bus = 1;  // code and data of SRAM come over one bus

// Code in SRAM is fetched over the system bus, where its loads and stores wait for it.
Fetch sram_stalls(Core core, const std::vector<Instruction>& run,
                  const std::vector<double>& cycles) {
  constexpr std::uint32_t kWord = 4;
  const double period = core == Core::cortex_m3 ? 2 : 1;
  Fetch fetch;
  fetch.entry = (period - 1) / 2;  // by where in its word the target lies
  std::uint32_t word = run.front().address / kWord;
  double now = 0, next_ready = period;
  for (std::size_t n = 0; n < run.size(); ++n) {
    double stall = run[n].accesses_memory() ? kShared_bus : 0;
    const std::uint32_t last = (run[n].address + run[n].bytes - 1) / kWord;
    while (word < last) {
      ++word;
      stall += std::max(0.0, next_ready - now - stall);
      next_ready = now + stall + period;
    }
    fetch.stalls.push_back(stall);
    now += stall + cycles[n];
  }
  return fetch;
}

}  // namespace

Fetch fetch_stalls(Core core, const FlashTiming& flash, const std::vector<Instruction>& run,
                   const std::vector<double>& cycles) {
  if (run.front().address >= kEnd_of_flash) return sram_stalls(core, run, cycles);
  Fetch fetch;
  fetch.stalls.assign(run.size(), 0);
  if (flash.wait_states == 0) return fetch;
  const double period = flash.wait_states + 1;
  std::uint32_t line = run.front().address / flash.line_bytes;
  if (flash.line_cache)
    fetch.lines.push_back({line, period - 1});
  else
    fetch.entry = period - 1;
  double now = 0;
  double next_ready = flash.prefetch ? period : 0;  // of the next line; without prefetch: not asked
  for (std::size_t n = 0; n < run.size(); ++n) {
    const std::uint32_t last = (run[n].address + run[n].bytes - 1) / flash.line_bytes;
    while (line < last) {
      ++line;
      const double stall = flash.prefetch ? std::max(0.0, next_ready - now) : period - 1;
      if (flash.line_cache) {
        if (stall > 0) fetch.lines.push_back({line, stall});
      } else {
        fetch.stalls[n] += stall;
        now += stall;
      }
      next_ready = now + period;
    }
    if (run[n].literal && !flash.data_cache) {  // the flash serves data first
      if (next_ready > now) next_ready += period;
      fetch.stalls[n] += period - 1;
      now += period - 1;
    }
    now += cycles[n];
  }
  return fetch;
}

}  // namespace whirl::cycles
