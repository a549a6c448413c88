#include "harness/executive/cpu_fault.hpp"

#include <gtest/gtest.h>

namespace whirl {
namespace {

results::CpuFaultRecord fault_at(std::uint32_t exception, const std::string& backtrace) {
  results::CpuFaultRecord record;
  record.t_ns = 50'000'000;
  record.registers.exception = exception;
  record.registers.pc = 0x08001234;
  record.registers.r[9] = 9;
  record.registers.r[10] = 0xA;
  record.registers.cfsr = (1u << 9) | (1u << 25);
  record.backtrace = backtrace;
  return record;
}

TEST(CpuFault, HasTheNameThatTheManualGivesIt) {
  const std::pair<std::uint32_t, const char*> kNames[] = {
      {2, "NMI"},      {3, "HardFault"},  {4, "MemManage fault"},
      {5, "BusFault"}, {6, "UsageFault"}, {255, "lock-up"},
      {7, "fault"}};
  for (const auto& [exception, name] : kNames)
    EXPECT_EQ(describe(fault_at(exception, "")).name, name);
}

TEST(CpuFault, IsWhereItsInnermostFrameIs) {
  EXPECT_EQ(describe(fault_at(3, "")).where, "0x08001234");
  EXPECT_EQ(describe(fault_at(3, "f+0x4 at 0x08001234\nmain at 0x08000100")).where,
            "f+0x4 at 0x08001234");
  EXPECT_EQ(describe(fault_at(3, "f+0x4\nmain")).where, "f+0x4 at 0x08001234");
}

TEST(CpuFault, ListsItsRegistersAndTheMeaningOfTheirBits) {
  const results::CpuFaultRow row = describe(fault_at(3, ""));
  EXPECT_DOUBLE_EQ(row.t_s, 0.05);
  EXPECT_NE(row.registers.find("r0   0x00000000\n"), std::string::npos) << row.registers;
  EXPECT_NE(row.registers.find(
                "r9   0x00000009\nr10  0x0000000A\nr11  0x00000000\nr12  0x00000000\nsp   "),
            std::string::npos)
      << row.registers;
  EXPECT_NE(row.registers.find("cfsr 0x02000200 PRECISERR DIVBYZERO\n"), std::string::npos)
      << row.registers;
}

}  // namespace
}  // namespace whirl
