// A Cortex-M3 or M4 behind a debug probe: flash, reset, registers of a fault, and where its program counter is.
//
//   Source   Armv7-M manual: B3.2 (System Control Space: CFSR 0xE000ED28, HFSR, MMFAR, BFAR), B1.5.6 (the stacked frame),
//            C1.8.6 (DWT_PCSR 0xE000101C, which is read while the core runs on)
//   Left out  what the handler has pushed since: the stacked frame is looked for at the stack pointer of the moment of
//             the halt, which is right at a vector catch, and in a handler that saved nothing
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/openocd/tcl_client.hpp"

namespace whirl::openocd {

inline constexpr std::uint32_t kPcsr = 0xE000101C, kCfsr = 0xE000ED28, kDemcr = 0xE000EDFC;

struct CoreState {
  std::uint32_t pc = 0, lr = 0, sp = 0, xpsr = 0;  // at the halt
  std::uint32_t exception = 0;                     // 0: none is served
  std::uint32_t cfsr = 0, hfsr = 0, mmfar = 0, bfar = 0;
  // r0-r3, r12, lr, pc, xpsr of the code that the exception interrupted.
  std::array<std::uint32_t, 8> stacked{};
};

class CoreProbe {
 public:
  explicit CoreProbe(TclClient& client) : client_(client) {}

  // Halts, erases, writes, reads back, resets. Errors  bad_input: openocd's own words
  Result<Done> flash(const std::string& elf);
  Result<Done> reset();
  Result<std::vector<std::uint32_t>> read_words(std::uint32_t address, int count);
  // Halts the core, reads, and lets it run on: a motor that is driven must not be turning then.
  Result<CoreState> look();
  // While it runs. The trace enable of DEMCR is set for it, and stays.
  Result<Done> start_sampling();
  Result<std::uint32_t> sample_pc();

 private:
  Result<std::uint32_t> read_register(const std::string& name);

  TclClient& client_;
};

}  // namespace whirl::openocd
