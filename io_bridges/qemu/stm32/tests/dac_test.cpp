#include "io_bridges/qemu/stm32/dac.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"
#include "io_bridges/qemu/stm32/tests/bare_chip.hpp"

namespace whirl::stm32 {
namespace {

using namespace test;

TEST(Dac, AHeldValueIsOutAtOnceOrAtItsTrigger) {
  BareChip bare;
  Dac dac(bare.chip(), 54);
  TriggerLine timer6;
  dac.connect_trigger(0, timer6);
  put(dac, 0x00, 1);
  put(dac, 0x08, 2048);
  EXPECT_TRUE(near(dac.volts(1), 1.65, round_off(4, 1.65)));
  put(dac, 0x00, 1 | 4);
  put(dac, 0x08, 1024);
  EXPECT_TRUE(near(dac.volts(1), 1.65, round_off(4, 1.65)));
  timer6.pulse(0);
  EXPECT_TRUE(near(dac.volts(1), 0.825, round_off(4, 0.825)));
  EXPECT_EQ(get(dac, 0x2C), 1024u);
}

TEST(Dac, AlignmentsAndTheDualRegistersMeanTheSameValue) {
  BareChip bare;
  Dac dac(bare.chip(), 54);
  put(dac, 0x00, 1 | 1u << 16);
  put(dac, 0x0C, 0xABC0);
  EXPECT_EQ(get(dac, 0x2C), 0xABCu);
  put(dac, 0x10, 0x12);
  EXPECT_EQ(get(dac, 0x2C), 0x120u);
  put(dac, 0x20, 0x07770333);
  EXPECT_EQ(get(dac, 0x2C), 0x333u);
  EXPECT_EQ(get(dac, 0x30), 0x777u);
}

TEST(Dac, ASecondTriggerBeforeTheDmaServedIsAnUnderrun) {
  BareChip bare;
  Dac dac(bare.chip(), 54);
  TriggerLine timer6;
  dac.connect_trigger(0, timer6);
  put(dac, 0x00, 1 | 4 | 1u << 12 | 1u << 13);
  timer6.pulse(0);
  EXPECT_TRUE(dac.request(1).level());
  EXPECT_FALSE(bare.interrupts.lines[54]);
  timer6.pulse(1);
  EXPECT_TRUE(bare.interrupts.lines[54]);
  put(dac, 0x34, 1u << 13);
  EXPECT_FALSE(bare.interrupts.lines[54]);
  dac.request(1).served();
  EXPECT_FALSE(dac.request(1).level());
}

// Once each: a register that is written again with what it has is no change.
TEST(Dac, WhoListensIsToldEachChangeOfTheLevelAndNoOther) {
  BareChip bare;
  Dac dac(bare.chip(), 54);
  std::vector<double> told;
  dac.on_change(1, [&](double volts) { told.push_back(volts); });
  put(dac, 0x08, 2048);  // not enabled
  put(dac, 0x00, 1);
  put(dac, 0x08, 2048);
  put(dac, 0x14, 100);  // of the other channel
  put(dac, 0x08, 1024);
  dac.reset();
  ASSERT_EQ(told.size(), 3u);
  EXPECT_TRUE(near(told[0], 1.65, round_off(4, 1.65)));
  EXPECT_TRUE(near(told[1], 0.825, round_off(4, 0.825)));
  EXPECT_TRUE(near(told[2], 0.0, round_off(4, 1.0)));
}

}  // namespace
}  // namespace whirl::stm32
