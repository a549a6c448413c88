#include "harness/executive/cpu_fault.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"

namespace whirl {
namespace {

results::CpuFaultRecord fault_at(std::uint32_t exception, const std::string& backtrace) {
  results::CpuFaultRecord record;
  record.t_ns = 50'000'000;
  record.registers.exception = exception;
  record.registers.pc = 0x08001234;
  for (std::uint32_t i = 0; i < 13; ++i) record.registers.r[i] = i;
  record.registers.sp = 0x20001000;
  record.registers.lr = 0x08000301;
  record.registers.xpsr = 0x01000003;
  record.registers.hfsr = 0x40000000;
  record.registers.mmfar = 4;
  record.registers.bfar = 8;
  record.registers.cfsr = (1u << 9) | (1u << 25);
  record.backtrace = backtrace;
  return record;
}

TEST(CpuFault, HasTheNameThatTheManualGivesIt) {
  const std::pair<std::uint32_t, const char*> kNames[] = {
      {2, "NMI"},
      {3, "HardFault"},
      {4, "MemManage fault"},
      {5, "BusFault"},
      {6, "UsageFault"},
      {255, "lock-up"},
      {7, "fault"},
      {254, "stack or vectors where registers or flash are"}};
  for (const auto& [exception, name] : kNames)
    EXPECT_EQ(describe(fault_at(exception, "")).name, name);
}

TEST(CpuFault, IsWhereItsInnermostFrameIs) {
  EXPECT_EQ(describe(fault_at(3, "")).where, "0x08001234");
  EXPECT_EQ(describe(fault_at(3, "f+0x4 at 0x08001234\nmain at 0x08000100")).where,
            "f+0x4 at 0x08001234");
  EXPECT_EQ(describe(fault_at(3, "f+0x4\nmain")).where, "f+0x4 at 0x08001234");
  // Outside of every function the backtrace has the address alone (Image::describe).
  results::CpuFaultRecord wild = fault_at(3, "0x0800abcd\nmain+0x8");
  wild.registers.pc = 0x0800ABCD;
  EXPECT_EQ(describe(wild).where, "0x0800abcd");
}

TEST(CpuFault, ListsItsRegistersAndTheMeaningOfTheirBits) {
  const results::CpuFaultRow row = describe(fault_at(3, "main"));
  EXPECT_TRUE(near(row.t_s, 0.05, round_off(4, 0.05)));
  EXPECT_EQ(row.registers,
            "r0   0x00000000\nr1   0x00000001\nr2   0x00000002\nr3   0x00000003\n"
            "r4   0x00000004\nr5   0x00000005\nr6   0x00000006\nr7   0x00000007\n"
            "r8   0x00000008\nr9   0x00000009\nr10  0x0000000a\nr11  0x0000000b\n"
            "r12  0x0000000c\nsp   0x20001000\nlr   0x08000301\npc   0x08001234\n"
            "xpsr 0x01000003\ncfsr 0x02000200 PRECISERR DIVBYZERO\nhfsr 0x40000000\n"
            "mmfar 0x00000004\nbfar 0x00000008\n");
  EXPECT_EQ(row.backtrace, "main");
}

}  // namespace
}  // namespace whirl
