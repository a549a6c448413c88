// Images and memories: what is refused, what is there, what survives a reset.
#include <gtest/gtest.h>

#include "io_bridges/qemu/tests/board_run.hpp"

namespace whirl::board_test {
namespace {

TEST(Image, MissingIsNamed) {
  const BoardRun run = run_for({"/nowhere/flight.elf", {}}, 1);
  EXPECT_EQ(run.error.kind, ErrorKind::bad_input);
  EXPECT_NE(run.error.message().find("/nowhere/flight.elf: cannot be read"), std::string::npos)
      << run.error.message();
}

TEST(Image, ATextIsNoElf) {
  const BoardRun run = run_for({"/proc/self/status", {}}, 1);
  EXPECT_EQ(run.error.kind, ErrorKind::bad_input);
  EXPECT_NE(run.error.what.find("not an ELF file"), std::string::npos) << run.error.message();
}

TEST(Image, AProgramOfThisHostIsForAnotherCpu) {
  const BoardRun run = run_for({"/proc/self/exe", {}}, 1);
  EXPECT_EQ(run.error.kind, ErrorKind::bad_input);
  EXPECT_NE(run.error.what.find("not for a 32-bit"), std::string::npos) << run.error.message();
}

TEST(Image, BeyondFlashIsRefusedWithItsSize) {
  const BoardRun run = run_for({image("big"), {}}, 1);
  EXPECT_EQ(run.error.kind, ErrorKind::bad_input);
  EXPECT_NE(run.error.what.find("does not fit into flash"), std::string::npos)
      << run.error.message();
}

TEST(Flash, KeepsWhatWasProgrammedAcrossASoftwareResetAndErasesToOnes) {
  const BoardRun run = run_for({image("flash"), {}}, 3);
  ASSERT_EQ(run.error.what, "");
  // Cell and reset cause at each of the three starts: power-on, software, independent watchdog.
  const std::vector<std::uint32_t> expected = {0xFFFFFFFF, 0,          0x12345678 & 0xFFFF00FF,
                                               2,          0xFFFFFFFF, 3};
  EXPECT_EQ(run.said(), expected);
  EXPECT_EQ(run.of(io::Kind::board_reset).size(), 2u);
}

TEST(Flash, AStoreWhileLockedIsABusFault) {
  const BoardRun run = run_for({image("locked_flash"), {}}, 1);
  const auto faults = run.of(io::Kind::cpu_fault);
  ASSERT_FALSE(faults.empty());
  EXPECT_EQ(faults[0]->as<io::CpuFault>().exception, 3u);
}

TEST(Memory, BeyondThePartsSramIsAHardFaultNamedByFunction) {
  const BoardRun run = run_for({image("fault"), {}}, 1);
  EXPECT_EQ(run.said().size(), 1u);  // the last word below is there
  const auto faults = run.of(io::Kind::cpu_fault);
  ASSERT_EQ(faults.size(), 1u);
  const auto fault = faults[0]->as<io::CpuFault>();
  EXPECT_EQ(fault.exception, 3u);
  EXPECT_EQ(fault.bfar, 0x20020000u);
  EXPECT_TRUE((fault.cfsr & (1u << 9)) != 0) << fault.cfsr;   // PRECISERR
  EXPECT_TRUE((fault.hfsr & (1u << 30)) != 0) << fault.hfsr;  // FORCED
  const std::string trace = run.text_of(*faults[0], sizeof(io::CpuFault));
  EXPECT_EQ(trace.find("read_beyond"), 0u) << trace;
  EXPECT_LT(trace.find("middle"), trace.find("main")) << trace;
}

TEST(Memory, RegistersThatNobodyAnswersAreNamedOnceWithWhoTouchedThem) {
  const BoardRun run = run_for({image("stray"), {}}, 1);
  std::vector<std::string> texts;
  for (const Message* finding : run.of(io::Kind::finding)) texts.push_back(run.text_of(*finding));
  ASSERT_EQ(texts.size(), 3u);  // two addresses and what the image said
  EXPECT_NE(texts[0].find("0x40007c00, written by poke"), std::string::npos) << texts[0];
  EXPECT_NE(texts[1].find("0x50001234, read by main"), std::string::npos) << texts[1];
  EXPECT_EQ(run.said(), std::vector<std::uint32_t>{0});
}

}  // namespace
}  // namespace whirl::board_test
