// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/fixed_rate.hpp"

namespace whirl::qemu {

std::vector<std::int64_t> FixedRate::translated(qemu_plugin_tb* block,
                                                const std::vector<std::uint32_t>& sites) {
  const std::size_t length = qemu_plugin_tb_n_insns(block);
  qemu_plugin_register_vcpu_tb_exec_inline(block, 0, &instructions_, length);
  std::vector<std::int64_t> behind;
  behind.reserve(sites.size());
  for (const std::uint32_t site : sites) behind.push_back(static_cast<std::int64_t>(length - site));
  return behind;
}

Nanoseconds FixedRate::time_at(std::int64_t behind) const {
  return anchor_ns_ + (static_cast<std::int64_t>(instructions_ - anchor_instructions_) - behind) *
                          ns_per_instruction_;
}

void FixedRate::anchor(Nanoseconds now) {
  anchor_ns_ = now;
  anchor_instructions_ = instructions_;
}

Moment FixedRate::moment_of(Nanoseconds time) const {
  return {time, cycles_ + static_cast<std::uint64_t>(static_cast<double>(time - counted_since_ns_) *
                                                     1e-9 * hclk_Hz_)};
}

bool FixedRate::retime(const board::CoreTiming& timing) {
  cycles_ = core_cycles();
  counted_since_ns_ = anchor_ns_;
  hclk_Hz_ = timing.hclk_Hz;
  return false;
}

}  // namespace whirl::qemu
