// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/register_sites.hpp"

namespace whirl::qemu {

bool RegisterSites::reached(std::uint32_t address) {
  const std::uint32_t at = place(address);
  if (at >= kFlash_B / 2) return false;
  if (known_.empty()) known_.assign(kFlash_B / 2, false);
  if (known_[at]) return false;
  known_[at] = true;
  return true;
}

}  // namespace whirl::qemu
