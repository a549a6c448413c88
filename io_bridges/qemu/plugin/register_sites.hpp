// SPDX-License-Identifier: GPL-2.0-or-later
//
// Which instructions of the guest have reached registers of the part.
//
//   Where   in flash, and where flash shows at address 0: others are not known
//   Worth   what a block can gain by it (CostInjection) is gained once it is translated anew
//   Moves   nothing in the guest: when that happens changes the host's time only
#pragma once
#include <cstdint>
#include <vector>

namespace whirl::qemu {

class RegisterSites {
 public:
  bool reaches(std::uint32_t address) const {
    const std::uint32_t at = place(address);
    return at < known_.size() && known_[at];
  }
  // An instruction has. True: for the first time.
  bool reached(std::uint32_t address);

 private:
  static constexpr std::uint32_t kFlash = 0x08000000, kFlash_B = 1u << 20;
  static std::uint32_t place(std::uint32_t address) { return (address & ~kFlash) >> 1; }

  std::vector<bool> known_;
};

}  // namespace whirl::qemu
