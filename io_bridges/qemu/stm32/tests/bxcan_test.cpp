// PCLK1 is 42 MHz: BRP 2, TS1 10, TS2 1 give 14 quanta of 71.4 ns, 1 Mbit/s.
#include "io_bridges/qemu/stm32/bxcan.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "base/near.hpp"
#include "io_bridges/qemu/stm32/can_frame_bits.hpp"
#include "io_bridges/qemu/stm32/tests/bare_chip.hpp"

namespace whirl::stm32 {
namespace {

using namespace test;

enum : std::uint32_t {
  MCR = 0,
  MSR = 4,
  TSR = 8,
  RF0R = 12,
  RF1R = 16,
  IER = 20,
  ESR = 24,
  BTR = 28,
  TI0R = 0x180,
  RI0R = 0x1B0,
  FMR = 0x200,
  FM1R = 0x204,
  FS1R = 0x20C,
  FFA1R = 0x214,
  FA1R = 0x21C,
  BANK0 = 0x240
};
constexpr std::uint32_t kOneMegabit = 2 | 10u << 16 | 1u << 20;

struct Listener : io::CanNode {
  std::vector<std::pair<Nanoseconds, io::CanFrame>> frames;
  void receive(const io::CanFrame& frame, Nanoseconds now) override {
    frames.emplace_back(now, frame);
  }
};

struct Can {
  BareChip bare;
  CanFilters filters{28};
  BxCan can{bare.chip(), {}, filters};

  void start(std::uint32_t btr) {
    put(can, MCR, 1);
    EXPECT_EQ(get(can, MSR) & 3, 1u);
    put(can, BTR, btr);
    put(can, FMR, get(can, FMR) | 1);
    put(can, FS1R, 1);
    put(can, FA1R, 1);  // bank 0: 32-bit mask of zeros takes everything into FIFO 0
    put(can, FMR, get(can, FMR) & ~1u);
    put(can, MCR, 0);
    bare.run_to(bare.events.now() + 11'100);  // eleven recessive bits
    EXPECT_EQ(get(can, MSR) & 3, 0u);
  }
  void send(std::uint32_t id, unsigned mailbox = 0) {
    put(can, TI0R + 16 * mailbox + 4, 2);
    put(can, TI0R + 16 * mailbox + 8, 0xBBAA);
    put(can, TI0R + 16 * mailbox, id << 21 | 1);
  }
};

TEST(BxCan, ResetsAsleepAndGoesThroughInitialisation) {
  Can c;
  EXPECT_EQ(get(c.can, MCR), 0x00010002u);
  EXPECT_EQ(get(c.can, MSR), 0x00000C02u);
  EXPECT_EQ(get(c.can, TSR), 0x1C000000u);
  EXPECT_EQ(get(c.can, BTR), 0x01230000u);
  EXPECT_EQ(get(c.can, FMR), 0x2A1C0E01u);
  c.start(kOneMegabit);
  EXPECT_TRUE(near(c.can.bit_time_s(), 1e-6, round_off(4, 1e-6)));
}

// ISO 11898: 47 + 8 n bits without stuffing for a standard frame with its interframe space, and
// at most (34 + 8 n - 1) / 4 stuff bits.
TEST(CanFrameBits, LieBetweenNoStuffingAndTheMost) {
  for (int n = 0; n <= 8; ++n) {
    for (const std::uint8_t fill : {0x00, 0x55, 0xFF, 0x0F}) {
      io::CanFrame frame;
      frame.id = 0x2AA;
      frame.length = static_cast<std::uint8_t>(n);
      for (std::uint8_t& byte : frame.data) byte = fill;
      EXPECT_GE(can_frame_bits(frame), 47 + 8 * n);
      EXPECT_LE(can_frame_bits(frame), 47 + 8 * n + (34 + 8 * n - 1) / 4);
      if (fill == 0x00 && n == 8) {
        EXPECT_GE(can_frame_bits(frame), 47 + 64 + 64 / 5);
      }
    }
  }
}

TEST(BxCan, AFrameArrivesWhenItsBitsHavePassed) {
  Can c;
  Listener listener;
  c.can.join(listener);
  c.start(kOneMegabit);
  const Nanoseconds start = c.bare.events.now();
  c.send(0x123);
  EXPECT_EQ(get(c.can, TSR) >> 26 & 7, 6u);
  c.bare.run_to(start + 200'000);
  ASSERT_EQ(listener.frames.size(), 1u);
  EXPECT_EQ(listener.frames[0].first, start + can_frame_bits(listener.frames[0].second) * 1000);
  EXPECT_EQ(listener.frames[0].second.id, 0x123u);
  EXPECT_EQ(listener.frames[0].second.data[1], 0xBB);
  EXPECT_EQ(get(c.can, TSR) & 0x1C000003, 0x1C000003u);
  put(c.can, TSR, 1);
  EXPECT_EQ(get(c.can, TSR) & 3, 0u);
}

TEST(BxCan, TheLowerIdentifierGoesFirst) {
  Can c;
  Listener listener;
  c.can.join(listener);
  c.start(kOneMegabit);
  c.send(0x300, 0);  // on the wire at once
  c.send(0x200, 1);
  c.send(0x100, 2);
  c.bare.run_to(c.bare.events.now() + 500'000);
  ASSERT_EQ(listener.frames.size(), 3u);
  EXPECT_EQ(listener.frames[1].second.id, 0x100u);
  EXPECT_EQ(listener.frames[2].second.id, 0x200u);
}

TEST(BxCan, WithNobodyThereItTurnsErrorPassiveAndTriesOnUntilAborted) {
  Can c;
  c.start(kOneMegabit);
  c.send(0x123);
  c.bare.run_to(c.bare.events.now() + 3'000'000);
  EXPECT_EQ(get(c.can, ESR), 128u << 16 | 3u << 4 | 3u);
  EXPECT_EQ(get(c.can, TSR) & 1, 0u);
  put(c.can, TSR, 0x80);
  c.bare.run_to(c.bare.events.now() + 200'000);
  EXPECT_EQ(get(c.can, TSR) & 3, 1u);
}

TEST(BxCan, LoopbackReceivesItsOwnFrameThroughTheFilters) {
  Can c;
  c.start(kOneMegabit | 1u << 30 | 1u << 31);
  put(c.can, IER, 2);
  c.send(0x7A5);
  c.bare.run_to(c.bare.events.now() + 200'000);
  EXPECT_TRUE(c.bare.interrupts.lines[20]);
  EXPECT_EQ(get(c.can, RF0R), 1u);
  EXPECT_EQ(get(c.can, RI0R), 0x7A5u << 21);
  EXPECT_EQ(get(c.can, RI0R + 4) & 15, 2u);
  EXPECT_EQ(get(c.can, RI0R + 8), 0xBBAAu);
  put(c.can, RF0R, 32);
  EXPECT_EQ(get(c.can, RF0R), 0u);
  EXPECT_FALSE(c.bare.interrupts.lines[20]);
}

TEST(BxCan, TheFourthFrameOverrunsAndOverwritesTheLastUnlessLocked) {
  for (const bool locked : {false, true}) {
    Can c;
    c.start(kOneMegabit);
    put(c.can, MCR, locked ? 8 : 0);
    for (std::uint32_t id = 1; id <= 4; ++id) {
      io::CanFrame frame;
      frame.id = id;
      c.can.receive(frame, 0);
    }
    EXPECT_EQ(get(c.can, RF0R), 3u | 8 | 16);
    put(c.can, RF0R, 32);
    put(c.can, RF0R, 32);
    EXPECT_EQ(get(c.can, RI0R) >> 21, locked ? 3u : 4u);
  }
}

// The example of RM0090's figure "Example of filter numbering", as far as FIFO 0 goes: bank 0 list
// 32 (0, 1), bank 1 mask 32 (2), bank 3 list 16 (3..6), bank 5 inactive mask 16? list 32 (7, 8).
TEST(CanFilters, NumbersRunOverInactiveBanksAndListsBeatMasks) {
  CanFilters filters(28);
  filters.write(FMR, 0x0E01);
  filters.write(FS1R, 0b0111);  // banks 0..2 are 32 bits wide, bank 3 16 bits
  filters.write(FM1R, 0b1101);  // 0 list, 1 mask, 2 list, 3 list
  filters.write(FFA1R, 0);
  filters.write(BANK0 + 0, 0x111u << 21);
  filters.write(BANK0 + 4, 0x112u << 21);
  filters.write(BANK0 + 8, 0);  // mask of zeros: everything
  filters.write(BANK0 + 12, 0);
  filters.write(BANK0 + 16, 0x333u << 21);
  filters.write(BANK0 + 20, 0x334u << 21);
  filters.write(BANK0 + 24, 0x441u << 5 | 0x442u << 21);
  filters.write(BANK0 + 28, 0x443u << 5 | 0x444u << 21);
  filters.write(FA1R, 0b1011);  // bank 2 stays inactive but keeps its numbers 3 and 4
  filters.write(FMR, 0x0E00);
  const auto index = [&](std::uint32_t id) {
    io::CanFrame frame;
    frame.id = id;
    return filters.match(frame, false).index;
  };
  EXPECT_EQ(index(0x112), 1u);
  EXPECT_EQ(index(0x333), 2u);  // only the mask takes it
  EXPECT_EQ(index(0x444), 2u);  // 32 bits beat 16
  filters.write(FA1R, 0b1001);
  EXPECT_EQ(index(0x444), 8u);
}

}  // namespace
}  // namespace whirl::stm32
