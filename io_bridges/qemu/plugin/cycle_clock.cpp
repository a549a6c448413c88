// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/cycle_clock.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace whirl::qemu {
namespace {

constexpr std::uint32_t kLspen = 1u << 30, kLspact = 1u << 0;  // of FPCCR
constexpr std::uint32_t kSite_at_start = 1;

cycles::Instruction read_instruction(const qemu_plugin_insn* insn) {
  const Code code = code_of(insn);
  return cycles::decode(static_cast<std::uint32_t>(qemu_plugin_insn_vaddr(insn)), code.first,
                        code.second, code.wide);
}

// The one core register that its address comes from, but for an offset in the instruction; -1: another way.
int base_of(const cycles::Instruction& i) {
  if (i.literal || std::popcount(i.address_from) != 1) return -1;
  return std::countr_zero(i.address_from);
}

}  // namespace

std::int64_t CycleClock::units(double cycles) const {
  return std::llround(cycles * units_per_cycle_);
}

// A stack lies in RAM, and its pointer is aligned, as the narrow encodings' offsets from it are.
BlockCost::Kind CycleClock::kind_of(const cycles::Instruction& i) const {
  constexpr std::uint32_t kSp = 1u << 13;
  const bool on_stack = i.address_from == kSp;
  const bool single = i.kind == cycles::Class::load || i.kind == cycles::Class::store;
  return {
      .memory = i.accesses_memory(),
      .leads_to_register = register_sites_.reaches(i.address) ? base_of(i) : -1,
      .reads_flash = !on_stack && !(i.literal && !timing_.flash.data_cache),
      .unaligned = single && !i.literal && !(on_stack && i.bytes == 2),
      .long_multiply = core_ == cycles::Core::cortex_m3 && i.kind == cycles::Class::long_multiply};
}

BlockCost CycleClock::cost_of(const std::vector<cycles::Instruction>& run) const {
  const std::vector<double> core = cycles::core_cycles(core_, run);
  const cycles::Fetch fetch = cycles::fetch_stalls(core_, timing_.flash, run, core);
  BlockCost cost;
  double until = 0;  // rounded as a sum: no block's error grows with its length
  for (std::size_t n = 0; n < run.size(); ++n) {
    const double then = until + core[n] + fetch.stalls[n];
    cost.each.push_back(units(then) - units(until));
    cost.kinds.push_back(kind_of(run[n]));
    cost.offsets.push_back(run[n].address - run.front().address);
    until = then;
  }
  const cycles::Instruction& last = run.back();
  cost.ends_in_branch = last.flow != cycles::Flow::next;
  if (last.flow == cycles::Flow::conditional) cost.taken = units(cycles::refill_cycles(last));
  cost.entry = units(fetch.entry);
  cost.lines.reserve(fetch.lines.size());
  for (const cycles::LineUse& use : fetch.lines) {
    cost.lines.push_back({use.line, units(use.cycles)});
  }
  cost.lazy_frame = units(cycles::kFloating_frame);
  cost.cycle = units(1);
  cost.flash_wait = units(timing_.flash.wait_states);
  cost.data_cache = timing_.flash.data_cache;
  return cost;
}

std::vector<std::int64_t> CycleClock::translated(qemu_plugin_tb* block,
                                                 const std::vector<std::uint32_t>& sites) {
  std::vector<cycles::Instruction> run;
  const std::size_t length = qemu_plugin_tb_n_insns(block);
  for (std::size_t n = 0; n < length; ++n) {
    run.push_back(read_instruction(qemu_plugin_tb_get_insn(block, n)));
  }
  const BlockCost cost = cost_of(run);
  const bool from_start = std::find(sites.begin(), sites.end(), 0u) != sites.end();
  code_.put(block, cost, from_start);
  std::vector<std::int64_t> ahead;
  ahead.reserve(sites.size());
  for (const std::uint32_t site : sites) {
    ahead.push_back(CostInjection::ahead_at(cost, site) * 2 + (site == 0 ? kSite_at_start : 0));
  }
  return ahead;
}

Moment CycleClock::at(std::int64_t site) const {
  std::int64_t now = (code_.count().now_ns() << kUnit_shift) + code_.debt() - (site >> 1);
  if ((site & kSite_at_start) != 0) now -= code_.stalled();
  return {(now + kUnits_per_ns / 2) >> kUnit_shift, cycles_at(now)};
}

// All time that QEMU counts, it counts where we think: checked wherever its clock may be read.
void CycleClock::anchor(Nanoseconds now) {
  if (code_.count().found() && code_.count().now_ns() != now) refuse_();
  anchor_ns_ = now;
  // What rounding has added up since the last edge known goes. It is far below the half of a quarter of a
  // cycle, and costs are whole quarters.
  const double cycles = cycles_since_edge();
  const double whole = std::round(cycles);
  if (whole > 0 && std::abs(cycles - whole) < 0.125) take_edge(whole);
}

double CycleClock::cycles_since_edge(std::int64_t units) const {
  if (units_per_cycle_ <= 0.0) return 0.0;
  return (static_cast<double>(units) - edge_units_) / units_per_cycle_;
}

std::uint64_t CycleClock::cycles_at(std::int64_t units) const {
  return edges_ + static_cast<std::uint64_t>(std::max(0.0, std::round(cycles_since_edge(units))));
}

void CycleClock::take_edge(double cycles) {
  edges_ += static_cast<std::uint64_t>(cycles);
  edge_units_ += cycles * units_per_cycle_;
  code_.owe(std::llround(edge_units_) - core_units());
}

Nanoseconds CycleClock::core_now() const {
  return (core_units() + kUnits_per_ns / 2) >> kUnit_shift;
}

double CycleClock::ahead_ns() const {
  return static_cast<double>(code_.debt()) / static_cast<double>(kUnits_per_ns);
}

std::uint64_t CycleClock::core_cycles() const {
  return cycles_at(core_units());
}

void CycleClock::exception(const board::CoreState& before, const board::CoreState& after,
                           std::uint32_t fpccr) {
  const bool returns = before.leaves_exception();
  if (!returns && after.exception() == before.exception()) return;
  code_.refetch();
  double cycles = 0;
  if (returns && after.exception() == 0) {
    cycles = cycles::kException_return;
    if (board::has_floating_frame(before.pc) && (fpccr & kLspact) == 0)
      cycles += cycles::kFloating_frame;
  } else if (returns) {
    cycles = cycles::kTail_chain;
  } else if (before.exception() == 0 || core_units() != entered_units_) {
    cycles = cycles::kException_entry;
    if (board::has_floating_frame(after.lr) && (fpccr & kLspen) == 0)
      cycles += cycles::kFloating_frame;
  }
  code_.owe(units(cycles));
  if (!returns) entered_units_ = core_units();
}

// The bridge to APB passes one transfer after the other, each of two PCLK, from an edge of PCLK. A write
// to a bit-band alias reads and writes the register in the time of one access: the bus does both, and the
// core does not wait for them.
void CycleClock::accessed(std::uint32_t address, bool write) {
  constexpr std::uint32_t kApb1 = 0x40000000, kApb2 = 0x40010000, kEnd_of_apb = 0x40018000;
  if (address < kApb1 || address >= kEnd_of_apb) return;
  const bool second = address >= kApb2;
  const double pclk_Hz = second ? timing_.pclk2_Hz : timing_.pclk1_Hz;
  if (pclk_Hz <= 0.0 || timing_.hclk_Hz <= 0.0) return;
  const double transfer_ns = 2e9 / pclk_Hz + 1e9 / timing_.hclk_Hz;
  Nanoseconds& free_ns = bridge_free_ns_[second ? 1 : 0];
  const Nanoseconds now = core_now();
  const Nanoseconds from = std::max(now, free_ns);
  free_ns = from + std::llround(transfer_ns);
  if (write && core_units() == alias_.after_units) return code_.owe(-alias_.own_units);
  const auto whole_cycles = [this](Nanoseconds ns) {
    return units(std::round(static_cast<double>(ns) * timing_.hclk_Hz * 1e-9));
  };
  const std::int64_t until_free = whole_cycles(from - now);
  const std::int64_t waited = write ? until_free : whole_cycles(free_ns - now);
  code_.owe(waited);
  alias_ = {write ? -1 : core_units(), waited - until_free};
}

// The core's clock goes on while it sleeps, so it goes on at an edge.
Nanoseconds CycleClock::slept(Nanoseconds from, Nanoseconds to) {
  const std::int64_t halted = (from << kUnit_shift) + code_.debt();
  anchor_ns_ = to;
  const std::int64_t behind = halted - (to << kUnit_shift);
  code_.set_debt(std::max<std::int64_t>(0, behind));
  take_edge(std::max(0.0, std::ceil(cycles_since_edge() - 1e-3)));
  return std::max<std::int64_t>(0, -behind) >> kUnit_shift;
}

bool CycleClock::retime(const board::CoreTiming& timing) {
  const bool stale = !(timing == timing_);
  if (timing_.flash.line_cache && !timing.flash.line_cache) code_.forget_code_lines();
  if (timing_.flash.data_cache && !timing.flash.data_cache) code_.forget_data_lines();
  if (timing.hclk_Hz != timing_.hclk_Hz) {
    edges_ = core_cycles();
    edge_units_ = static_cast<double>(core_units());
    units_per_cycle_ = 1e9 / timing.hclk_Hz * static_cast<double>(kUnits_per_ns);
  }
  timing_ = timing;
  return stale;
}

}  // namespace whirl::qemu
