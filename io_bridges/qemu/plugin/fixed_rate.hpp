// SPDX-License-Identifier: GPL-2.0-or-later
//
// Every instruction takes the same time, whatever it is and whatever the clocks are.
//
//   Method  each basic block adds its length to a counter in line, at its start; at every event,
//           exception and register access, where QEMU's clock is exact, clock and counter are taken
//           down together
#pragma once
#include "io_bridges/qemu/plugin/core_clock.hpp"

namespace whirl::qemu {

class FixedRate final : public CoreClock {
 public:
  explicit FixedRate(std::int64_t ns_per_instruction) : ns_per_instruction_(ns_per_instruction) {}

  Result<Done> find_qemu() override { return Done{}; }
  std::vector<std::int64_t> translated(qemu_plugin_tb* block,
                                       const std::vector<std::uint32_t>& sites) override;
  void code_thrown_away() override {}
  Moment at(std::int64_t behind) const override { return moment_of(time_at(behind)); }
  void anchor(Nanoseconds now) override;
  Nanoseconds core_now() const override { return time_at(0); }
  double ahead_ns() const override { return 0; }
  std::uint64_t core_cycles() const override { return moment_of(anchor_ns_).cycles; }
  void exception(const board::CoreState&, const board::CoreState&, std::uint32_t) override {}
  void accessed(std::uint32_t, bool) override {}
  Nanoseconds slept(Nanoseconds from, Nanoseconds to) override { return to - from; }
  bool retime(const board::CoreTiming& timing) override;

 private:
  Nanoseconds time_at(std::int64_t behind) const;
  Moment moment_of(Nanoseconds time) const;

  const std::int64_t ns_per_instruction_;
  std::uint64_t instructions_ = 0;  // written by translated code
  std::uint64_t anchor_instructions_ = 0;
  Nanoseconds anchor_ns_ = 0;
  double hclk_Hz_ = 0.0;
  Nanoseconds counted_since_ns_ = 0;
  std::uint64_t cycles_ = 0;  // until then
};

}  // namespace whirl::qemu
