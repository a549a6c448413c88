// SPDX-License-Identifier: GPL-2.0-or-later
//
// Virtual time by the cycles that the core takes, at the HCLK and with the wait states that the
// firmware has set up at that moment.
//
//   Model     io_bridges/qemu/cycles; a change of clock or wait states throws all translated code away
//   Exact     a deadline is met within the instruction in which it falls, and asleep to the ns; the core
//             goes on at an edge of HCLK
//   Entry     12 cycles; 6 from handler to handler; 10 back. A request that comes before the first
//             instruction of a handler, and goes before it, costs nothing more (late arrival). FPU
//             registers are paid for when they are saved: at entry, or late
//   Buses     an access to APB waits for the bridge; a store leaves the core at once and holds the
//             bridge instead. So does a write to a bit-band alias, for two transfers (DDI 0337G 12.10:
//             the core waits only if it comes to the bus meanwhile)
//   Charged   the core's own accesses. DMA moves what registers hold past this clock (stm32::DmaBus, which
//             tells the bound on what the core may have waited for it), and costs the core nothing where it
//             finds no register
//   Left out  see core_model.hpp and fetch_model.hpp; bit-band aliases of SRAM and of AHB, DMA on the
//             buses
//   Source    ARM: DDI 0403E B1.5; AMBA APB: two PCLK a transfer; RM0090 2.1 and RM0008 3.1
#pragma once
#include <functional>

#include "io_bridges/qemu/cycles/core_model.hpp"
#include "io_bridges/qemu/plugin/core_clock.hpp"
#include "io_bridges/qemu/plugin/cost_injection.hpp"
#include "io_bridges/qemu/plugin/register_sites.hpp"

namespace whirl::qemu {

class CycleClock final : public CoreClock {
 public:
  CycleClock(const Api& api, cycles::Core core, std::function<void()> refuse)
      : core_(core), refuse_(refuse), code_(api, std::move(refuse)) {}

  Result<Done> find_qemu() override { return code_.find_qemu(); }
  std::vector<std::int64_t> translated(qemu_plugin_tb* block,
                                       const std::vector<std::uint32_t>& sites) override;
  void code_thrown_away() override { code_.code_thrown_away(); }
  bool asked_for_part() override { return code_.asked_for_part(); }
  bool reached_register(std::uint32_t pc) override { return register_sites_.reached(pc); }
  Moment at(std::int64_t site) const override;
  void settle() override { code_.settle(); }
  void anchor(Nanoseconds now) override;
  Nanoseconds core_now() const override;
  double ahead_ns() const override;
  std::uint64_t core_cycles() const override;
  void exception(const board::CoreState& before, const board::CoreState& after,
                 std::uint32_t fpccr) override;
  void accessed(std::uint32_t address, bool write) override;
  Nanoseconds slept(Nanoseconds from, Nanoseconds to) override;
  bool retime(const board::CoreTiming& timing) override;

 private:
  std::int64_t units(double cycles) const;
  BlockCost::Kind kind_of(const cycles::Instruction& i) const;
  BlockCost cost_of(const std::vector<cycles::Instruction>& run) const;
  std::int64_t core_units() const { return (anchor_ns_ << kUnit_shift) + code_.debt(); }
  double cycles_since_edge(std::int64_t units) const;
  double cycles_since_edge() const { return cycles_since_edge(core_units()); }
  std::uint64_t cycles_at(std::int64_t units) const;
  void take_edge(double cycles);

  const cycles::Core core_;
  std::function<void()> refuse_;
  CostInjection code_;
  RegisterSites register_sites_;
  board::CoreTiming timing_;
  double units_per_cycle_ = 0.0;
  Nanoseconds anchor_ns_ = 0;
  // An edge of HCLK, and how many there were until then.
  double edge_units_ = 0.0;
  std::uint64_t edges_ = 0;
  Nanoseconds bridge_free_ns_[2] = {};  // APB1, APB2
  struct {
    std::int64_t after_units = -1, own_units = 0;
  } alias_;  // the core's time behind its last access, if that was a read, and what that itself took
  std::int64_t entered_units_ = -1;  // the core's time behind its last exception entry
};

}  // namespace whirl::qemu
