#include "harness/executive/cpu_fault.hpp"

#include "base/text.hpp"

namespace whirl {
namespace {

const char* exception_name(std::uint32_t exception) {
  switch (exception) {
    case 2:
      return "NMI";
    case 3:
      return "HardFault";
    case 4:
      return "MemManage fault";
    case 5:
      return "BusFault";
    case 6:
      return "UsageFault";
    case 254:
      return "stack or vectors where registers or flash are";
    case 255:
      return "lock-up";
    default:
      return "fault";
  }
}

struct Bit {
  std::uint32_t mask;
  const char* meaning;
};

// CFSR and HFSR as the Armv7-M manual names them (B3.2.15, B3.2.16).
constexpr Bit kCfsr[] = {
    {1u << 0, "IACCVIOL"},   {1u << 1, "DACCVIOL"},     {1u << 3, "MUNSTKERR"},
    {1u << 4, "MSTKERR"},    {1u << 5, "MLSPERR"},      {1u << 8, "IBUSERR"},
    {1u << 9, "PRECISERR"},  {1u << 10, "IMPRECISERR"}, {1u << 11, "UNSTKERR"},
    {1u << 12, "STKERR"},    {1u << 13, "LSPERR"},      {1u << 16, "UNDEFINSTR"},
    {1u << 17, "INVSTATE"},  {1u << 18, "INVPC"},       {1u << 19, "NOCP"},
    {1u << 24, "UNALIGNED"}, {1u << 25, "DIVBYZERO"},
};

std::string reasons(std::uint32_t cfsr) {
  std::string text;
  for (const Bit& bit : kCfsr) {
    if ((cfsr & bit.mask) != 0) text += std::string(" ") + bit.meaning;
  }
  return text;
}

}  // namespace

results::CpuFaultRow describe(const results::CpuFaultRecord& fault) {
  const io::CpuFault& f = fault.registers;
  results::CpuFaultRow row;
  row.name = exception_name(f.exception);
  row.t_s = static_cast<double>(fault.t_ns) * 1e-9;
  row.backtrace = fault.backtrace;
  const std::string innermost = fault.backtrace.substr(0, fault.backtrace.find('\n'));
  row.where = innermost.empty() ? hex(f.pc) : innermost;
  if (row.where.find(hex(f.pc)) == std::string::npos) row.where += " at " + hex(f.pc);
  for (int i = 0; i < 13; ++i) {
    row.registers += "r" + std::to_string(i) + (i < 10 ? "   " : "  ") + hex(f.r[i]) + "\n";
  }
  row.registers += "sp   " + hex(f.sp) + "\nlr   " + hex(f.lr) + "\npc   " + hex(f.pc) + "\nxpsr " +
                   hex(f.xpsr) + "\ncfsr " + hex(f.cfsr) + reasons(f.cfsr) + "\nhfsr " +
                   hex(f.hfsr) + "\nmmfar " + hex(f.mmfar) + "\nbfar " + hex(f.bfar) + "\n";
  return row;
}

}  // namespace whirl
