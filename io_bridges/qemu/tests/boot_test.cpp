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

io::CpuFault facts_of(const std::string& name, const std::string& mcu) {
  BoardSetup setup{image(name), {}};
  setup.mcu = mcu;
  const BoardRun run = run_for(setup, 2);
  EXPECT_EQ(run.error.what, "");
  const auto faults = run.of(io::Kind::cpu_fault);
  return faults.empty() ? io::CpuFault{} : faults[0]->as<io::CpuFault>();
}

TEST(Parts, F405IsWhatItsManualSays) {
  const io::CpuFault facts = facts_of("f405", "stm32f405rg");
  EXPECT_EQ(facts.bfar, 0x20020000u);                // 128 KiB of SRAM (RM0090 2.3.1)
  EXPECT_EQ(facts.r[4], 1024u);                      // flash size (RM0090 39.2)
  EXPECT_EQ(facts.r[5] & 0xFE000000u, 0x14000000u);  // SFTRSTF and PINRSTF (RM0090 7.3.21)
  EXPECT_EQ(facts.r[6], 1u << 5);                    // bit-band (RM0090 2.3.3)
  EXPECT_EQ(facts.r[8] & 0xFFFu, 0x413u);            // DEV_ID (RM0090 38.6.1), kept in CCM
}

TEST(Parts, F103IsWhatItsManualSays) {
  const io::CpuFault facts = facts_of("f103", "stm32f103cb");
  EXPECT_EQ(facts.bfar, 0x08020000u);                // 128 KiB of flash
  EXPECT_EQ(facts.r[4], 128u);                       // its size (RM0008 30.1)
  EXPECT_EQ(facts.r[5] & 0xFE000000u, 0x0C000000u);  // PORRSTF and PINRSTF (RM0008 7.3.10)
  EXPECT_EQ(facts.r[6], 0x600Du);                    // the end of 20 KiB of SRAM
  EXPECT_EQ(facts.r[7] & 0xFFFu, 0x410u);            // DEV_ID (RM0008 31.6.1)
}

}  // namespace
}  // namespace whirl::board_test
