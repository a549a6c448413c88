#include "io_bridges/qemu/cycles/core_model.hpp"

#include <algorithm>

namespace whirl::cycles {
namespace {

// Where ARM gives a range.
constexpr double kRefill_branch = 1.5;  // 1 to 3 by alignment and width: the mean over alignments
constexpr double kRefill_register = 1.5;
constexpr double kRefill_load = 3;            // "at least" 5 for LDR PC, with its 2 of a load
constexpr double kDivide = 2;                 // at least; see core_model.hpp
constexpr double kLong_multiply_m3 = 3;       // at least; see core_model.hpp
constexpr double kLiteral = 0.25;             // meets the instruction fetch in some alignments
constexpr double kStore_register_offset = 1;  // [Rn, #imm] alone is "always one cycle"
constexpr double kLoad_after_store = 1;       // the write buffer is emptied first
constexpr double kBarrier = 4;                // ISB refills, DSB waits for the write buffer
constexpr double kFp_divide = 14;             // the integer pipeline goes on meanwhile

// Cycles by class, DDI 0337 table 18-1 and DDI 0439 table 3-1, 7-1.
struct Row {
  Class kind;
  double m3, m4;
};
constexpr Row kTable[] = {
    {Class::plain, 1, 1},
    {Class::it, 1, 1},
    {Class::multiply, 1, 1},
    {Class::accumulate, 2, 1},
    {Class::long_multiply, kLong_multiply_m3, 1},
    {Class::divide, kDivide, kDivide},
    {Class::load, 2, 2},
    {Class::store, 1, 1},
    {Class::load_many, 1, 1},   // and one for each register
    {Class::store_many, 1, 1},  // and one for each register
    {Class::exclusive, 2, 2},
    {Class::table_branch, 3, 3},
    {Class::barrier, kBarrier, kBarrier},
    {Class::special, 2, 2},
    {Class::fp, 1, 1},
    {Class::fp_accumulate, 3, 3},
    {Class::fp_divide, 1, 1},  // and waits for the divider
    {Class::fp_load, 2, 2},
    {Class::fp_store, 2, 2},
    {Class::fp_load_many, 1, 1},   // and one for each register
    {Class::fp_store_many, 1, 1},  // and one for each register
    {Class::fp_move_two, 2, 2},
};
constexpr bool in_order() {
  for (std::size_t n = 0; n < std::size(kTable); ++n) {
    if (static_cast<std::size_t>(kTable[n].kind) != n) return false;
  }
  return std::size(kTable) == static_cast<std::size_t>(Class::fp_move_two) + 1;
}
static_assert(in_order());

double alone(Core core, const Instruction& i) {
  const Row& row = kTable[static_cast<std::size_t>(i.kind)];
  double cycles = (core == Core::cortex_m3 ? row.m3 : row.m4) + i.registers;
  if (i.doubleword) cycles += 1;
  if (core == Core::cortex_m3 && i.accumulates) cycles += i.with_sign ? 2 : 1;
  if (i.literal) cycles += kLiteral;
  if (i.kind == Class::store && i.register_offset) cycles += kStore_register_offset;
  if (i.flow == Flow::direct || i.flow == Flow::indirect) cycles += refill_cycles(i);
  return cycles;
}

bool is_single_load(const Instruction& i) {
  return i.kind == Class::load || i.kind == Class::fp_load;
}

bool is_single_store(const Instruction& i) {
  return i.kind == Class::store || i.kind == Class::fp_store;
}

// What the instruction before it adds or saves.
double beside(const Instruction& before, const Instruction& i, double cycles) {
  const bool needs_address = (before.writes & i.address_from) != 0;
  double change = 0;
  // Neighbouring single loads share a cycle: the address of the next goes out while data comes in.
  const bool pipelined = is_single_load(before) && !before.updates_base && is_single_load(i) &&
                         i.flow == Flow::next && !needs_address;
  if (pipelined && cycles > 1) change -= 1;
  // A result is not forwarded into an address.
  if (i.accesses_memory() && needs_address && !before.accesses_memory()) change += 1;
  if ((before.fp_writes & i.fp_reads) != 0 && !before.accesses_memory()) change += 1;
  if (is_single_load(i) && is_single_store(before)) change += kLoad_after_store;
  if (i.folding_it && before.bytes == 2 && !before.accesses_memory()) change = -cycles;
  return change;
}

}  // namespace

double refill_cycles(const Instruction& i) {
  if (i.flow == Flow::next) return 0;
  if (i.flow != Flow::indirect) return kRefill_branch;
  return i.loads() ? kRefill_load : kRefill_register;
}

std::vector<double> core_cycles(Core core, const std::vector<Instruction>& run) {
  std::vector<double> cycles;
  double now = 0, divider_free = 0;
  for (std::size_t n = 0; n < run.size(); ++n) {
    const Instruction& i = run[n];
    double c = alone(core, i);
    if (n > 0) c += beside(run[n - 1], i, c);
    if (i.floating()) c += std::max(0.0, divider_free - now);
    now += c;
    if (i.kind == Class::fp_divide) divider_free = now - 1 + kFp_divide;
    cycles.push_back(c);
  }
  // Whoever comes next may need the quotient at once.
  if (divider_free > now) cycles.back() += divider_free - now;
  return cycles;
}

}  // namespace whirl::cycles
