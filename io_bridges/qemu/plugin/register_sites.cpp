// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/register_sites.hpp"

namespace whirl::qemu {

bool RegisterSites::reached(std::uint32_t address) {
  const std::uint32_t at = place(address);
  if (at >= kFlash_B / 2) return false;
  if (known_.empty()) known_.assign(kFlash_B / 2, Known::no);
  if (known_[at] == Known::before) return false;
  known_[at] = Known::since;
  return ++late_ == kWorth_it;
}

void RegisterSites::code_thrown_away() {
  late_ = 0;
  for (Known& known : known_) {
    if (known == Known::since) known = Known::before;
  }
}

}  // namespace whirl::qemu
