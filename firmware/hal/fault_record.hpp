// What the fault handler leaves behind: at the symbol fw_fault_record, in RAM that a reset keeps.
#pragma once
#include <cstdint>

namespace fw {

struct FaultRecord {
  static constexpr std::uint32_t kMagic = 0xFA01'7EC0;
  std::uint32_t magic;  // kMagic: the rest is valid
  std::uint32_t exception;
  std::uint32_t r[13];
  std::uint32_t sp, lr, pc, xpsr;
  std::uint32_t cfsr, hfsr, mmfar, bfar;
};

}  // namespace fw

extern "C" fw::FaultRecord fw_fault_record;
