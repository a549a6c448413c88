// Sequences whose cycles can be told from ARM's tables by hand.
#include <gtest/gtest.h>

#include <initializer_list>
#include <numeric>

#include "io_bridges/qemu/cycles/core_model.hpp"
#include "io_bridges/qemu/cycles/fetch_model.hpp"

namespace whirl::cycles {
namespace {

constexpr std::uint32_t kFlash = 0x08000000, kSram = 0x20000000;

// Machine code; what is above 0xFFFF is a wide encoding.
std::vector<Instruction> run_of(std::initializer_list<std::uint32_t> codes,
                                std::uint32_t address = kFlash) {
  std::vector<Instruction> run;
  for (const std::uint32_t code : codes) {
    const bool wide = code > 0xFFFF;
    run.push_back(decode(address, static_cast<std::uint16_t>(wide ? code >> 16 : code),
                         static_cast<std::uint16_t>(code), wide));
    address += wide ? 4 : 2;
  }
  return run;
}

std::vector<double> m4(std::initializer_list<std::uint32_t> codes) {
  return core_cycles(Core::cortex_m4f, run_of(codes));
}
std::vector<double> m3(std::initializer_list<std::uint32_t> codes) {
  return core_cycles(Core::cortex_m3, run_of(codes));
}
double sum(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0);
}

constexpr std::uint32_t kNop = 0xBF00, kAdds_r0 = 0x3001, kMul = 0x4348, kMla = 0xFB010002,
                        kUmull = 0xFBA12300, kUdiv = 0xFBB1F2F0, kLdr_r1_r0 = 0x6801,
                        kLdr_r2_r0 = 0x6842, kLdr_r3_r1 = 0x680B, kStr_r1_r0 = 0x6001,
                        kLdm_r0_8 = 0xC8FF, kPush_4 = 0xB40F, kPop_pc = 0xBD10,
                        kLdr_literal = 0x4801, kLdrd = 0xE9D01200, kB = 0xE7FE, kBne = 0xD1FE,
                        kBx_lr = 0x4770, kTbb = 0xE8D0F001, kVadd_s0 = 0xEE300A20,
                        kVadd_s1_s0 = 0xEE700A20, kVmla = 0xEE000A20, kVdiv = 0xEE800A20,
                        kVldr = 0xED900A00, kVldr_d = 0xED900B00, kVldm_4 = 0xEC900A04,
                        kIte = 0xBF0C, kCmp = 0x2800, kStr_r0_r1_r2 = 0x5088,
                        kStr_w_r0_r1_r2 = 0xF8410002;

TEST(CoreModel, EachClassTakesWhatItsRowSays) {
  EXPECT_EQ(m4({kNop}), std::vector<double>{1});
  EXPECT_EQ(m4({kMul}), std::vector<double>{1});
  EXPECT_EQ(m4({kMla}), std::vector<double>{1});
  EXPECT_EQ(m3({kMla}), std::vector<double>{2});
  EXPECT_EQ(m4({kUmull}), std::vector<double>{1});
  EXPECT_GE(m3({kUmull})[0], 3);
  EXPECT_LE(m3({kUmull})[0], 7);
  EXPECT_GE(m4({kUdiv})[0], 2);
  EXPECT_LE(m4({kUdiv})[0], 12);
  EXPECT_EQ(m4({kLdr_r1_r0}), std::vector<double>{2});
  EXPECT_EQ(m4({kStr_r1_r0}), std::vector<double>{1});
  EXPECT_EQ(m4({kStr_r0_r1_r2}), std::vector<double>{2});
  EXPECT_EQ(m3({kStr_w_r0_r1_r2}), std::vector<double>{2});
  EXPECT_EQ(m4({kLdm_r0_8}), std::vector<double>{9});
  EXPECT_EQ(m4({kPush_4}), std::vector<double>{5});
  EXPECT_EQ(m4({kLdrd}), std::vector<double>{3});
  EXPECT_EQ(m4({kVadd_s0}), std::vector<double>{1});
  EXPECT_EQ(m4({kVmla}), std::vector<double>{3});
  EXPECT_EQ(m4({kVldr}), std::vector<double>{2});
  EXPECT_EQ(m4({kVldr_d}), std::vector<double>{3});
  EXPECT_EQ(m4({kVldm_4}), std::vector<double>{5});
  EXPECT_EQ(m4({kVdiv}), std::vector<double>{14});
}

TEST(CoreModel, BranchesRefillWhereTheyAreTaken) {
  EXPECT_EQ(m4({kBne}), std::vector<double>{1});  // and its refill when taken
  const Instruction bne = run_of({kBne})[0], pop = run_of({kPop_pc})[0];
  EXPECT_EQ(bne.flow, Flow::conditional);
  EXPECT_GE(refill_cycles(bne), 1);
  EXPECT_LE(refill_cycles(bne), 3);
  EXPECT_EQ(m4({kB})[0], 1 + refill_cycles(bne));
  EXPECT_EQ(pop.flow, Flow::indirect);
  EXPECT_EQ(m4({kPop_pc})[0], 3 + refill_cycles(pop));
  EXPECT_GE(m4({kTbb})[0], 6);
  EXPECT_EQ(run_of({kBx_lr})[0].flow, Flow::indirect);
}

TEST(CoreModel, NeighbouringLoadsShareACycleUnlessOneNeedsTheOther) {
  EXPECT_EQ(sum(m4({kLdr_r1_r0, kLdr_r2_r0})), 3);
  EXPECT_EQ(sum(m4({kLdr_r1_r0, kLdr_r3_r1})), 4);
  EXPECT_EQ(sum(m4({kAdds_r0, kLdr_r1_r0})), 1 + 2 + 1);  // no forwarding into an address
}

TEST(CoreModel, AResultOfTheFpuIsACycleLateAndADivisionGoesOnBesideIntegers) {
  EXPECT_EQ(sum(m4({kVadd_s0, kVadd_s1_s0})), 3);
  const auto beside = m4({kVdiv, kNop, kNop, kNop});
  EXPECT_EQ(sum(beside), 14);
  EXPECT_EQ(beside[1], 1);
  EXPECT_EQ(sum(m4({kVdiv, kNop, kVmla})), 14 + 3);
}

TEST(CoreModel, AnItFoldsIntoANarrowPredecessor) {
  EXPECT_EQ(sum(m4({kCmp, kIte, kNop, kNop})), 3);
  EXPECT_EQ(sum(m4({kMla, kIte, kNop, kNop})), 4);
}

const FlashTiming kArt{5, 16, true, true, true}, kF1{2, 8, true, false, false};

Fetch fetch(const FlashTiming& flash, const std::vector<Instruction>& run) {
  return fetch_stalls(Core::cortex_m3, flash, run, core_cycles(Core::cortex_m3, run));
}

TEST(FetchModel, WithoutWaitStatesNothingStalls) {
  const Fetch f = fetch({}, run_of({kNop, kNop, kNop, kNop, kNop}));
  EXPECT_EQ(sum(f.stalls), 0);
  EXPECT_EQ(f.entry, 0);
  EXPECT_TRUE(f.lines.empty());
}

TEST(FetchModel, AnF103WaitsForALineThatPrefetchHasNotBroughtYet) {
  // Four instructions of a cycle each cover the three of the next line; a wide one comes too early.
  EXPECT_EQ(sum(fetch(kF1, run_of({kNop, kNop, kNop, kNop, kNop})).stalls), 0);
  EXPECT_EQ(sum(fetch(kF1, run_of({kMla & 0xFFFFFFFFu, kUdiv, kNop})).stalls), 0);
  EXPECT_EQ(sum(fetch(kF1, run_of({0xF1000001, 0xF1000001, kNop})).stalls), 1);  // ADD.W
  EXPECT_EQ(fetch(kF1, run_of({kNop})).entry, 2);
  const FlashTiming bare{2, 8, false, false, false};
  EXPECT_EQ(sum(fetch(bare, run_of({kNop, kNop, kNop, kNop, kNop})).stalls), 2);
}

TEST(FetchModel, ALiteralIsReadFromFlashUnlessItsCacheHoldsIt) {
  EXPECT_EQ(sum(fetch(kF1, run_of({kLdr_literal})).stalls), 2);
  EXPECT_EQ(sum(fetch(kArt, run_of({kLdr_literal})).stalls), 0);
}

TEST(FetchModel, TheCacheOfTheF405LooksUpTargetsAndLinesThatPrefetchMisses) {
  const Fetch f = fetch(kArt, run_of({kNop, kNop, kNop, kNop, kNop, kNop, kNop, kNop, kNop}));
  ASSERT_EQ(f.lines.size(), 1u);  // its own; the next came while eight were executed
  EXPECT_EQ(f.lines[0].line, kFlash / 16);
  EXPECT_EQ(f.lines[0].cycles, 5);
  const Fetch wide = fetch(kArt, run_of({0xF1000001, 0xF1000001, 0xF1000001, 0xF1000001, kNop}));
  ASSERT_EQ(wide.lines.size(), 2u);
  EXPECT_EQ(wide.lines[1].cycles, 2);  // four of its six cycles have gone by
}

TEST(FetchModel, CodeInSramSharesItsBusWithItsData) {
  const Fetch f = fetch(kArt, run_of({kLdr_r1_r0, kNop}, kSram));
  EXPECT_EQ(f.stalls, (std::vector<double>{1, 0}));
  EXPECT_TRUE(f.lines.empty());
  // An M3 has a word of code every other cycle: two narrow instructions keep up, wide ones wait.
  const auto narrow = run_of({kNop, kNop, kNop, kNop, kNop, kNop}, kSram);
  const auto wide = run_of({0xF1000001, 0xF1000001, 0xF1000001, 0xF1000001}, kSram);
  EXPECT_EQ(sum(fetch(kArt, narrow).stalls), 0);
  EXPECT_EQ(sum(fetch(kArt, wide).stalls), 3);
  const auto m4_cycles = core_cycles(Core::cortex_m4f, wide);
  EXPECT_EQ(sum(fetch_stalls(Core::cortex_m4f, kArt, wide, m4_cycles).stalls), 0);
}

}  // namespace
}  // namespace whirl::cycles
