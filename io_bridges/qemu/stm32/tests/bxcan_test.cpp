// PCLK1 is 42 MHz: BRP 2, TS1 10, TS2 1 give 14 quanta of 71.4 ns, 1 Mbit/s.
#include "io_bridges/qemu/stm32/bxcan.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "base/near.hpp"
#include "io_bridges/devices/can_wire_faults.hpp"
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
  io::CanFrame own;
  bool wants = false;
  const io::CanFrame* offered() override { return wants ? &own : nullptr; }
  void sent(Nanoseconds /*now*/) override { wants = false; }
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
  io::CanStation& add(Listener& listener, double bit_ns = 1000.0) {
    io::CanStation& station = can.bus().join(listener, "listener", 0);
    can.bus().configure(station, bit_ns);
    can.bus().connect(station, 1);
    return station;
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
TEST(BxCan, FrameBitsLieBetweenNoStuffingAndTheMost) {
  for (int n = 0; n <= 8; ++n) {
    for (const std::uint8_t fill : {0x00, 0x55, 0xFF, 0x0F}) {
      io::CanFrame frame;
      frame.id = 0x2AA;
      frame.length = static_cast<std::uint8_t>(n);
      for (std::uint8_t& byte : frame.data) byte = fill;
      EXPECT_GE(io::can_frame_bits(frame), 47 + 8 * n);
      EXPECT_LE(io::can_frame_bits(frame), 47 + 8 * n + (34 + 8 * n - 1) / 4);
      if (fill == 0x00 && n == 8) {
        EXPECT_GE(io::can_frame_bits(frame), 47 + 64 + 64 / 5);
      }
    }
  }
}

TEST(BxCan, AFrameArrivesWhenItsBitsHavePassed) {
  Can c;
  Listener listener;
  c.add(listener);
  c.start(kOneMegabit);
  const Nanoseconds start = c.bare.events.now();
  c.send(0x123);
  EXPECT_EQ(get(c.can, TSR) >> 26 & 7, 6u);
  c.bare.run_to(start + 200'000);
  ASSERT_EQ(listener.frames.size(), 1u);
  EXPECT_EQ(listener.frames[0].first,
            start + (io::can_frame_bits(listener.frames[0].second) - 3) * 1000);
  EXPECT_EQ(listener.frames[0].second.id, 0x123u);
  EXPECT_EQ(listener.frames[0].second.data[1], 0xBB);
  EXPECT_EQ(get(c.can, TSR) & 0x1C000003, 0x1C000003u);
  put(c.can, TSR, 1);
  EXPECT_EQ(get(c.can, TSR) & 3, 0u);
}

TEST(BxCan, TheLowerIdentifierGoesFirst) {
  Can c;
  Listener listener;
  c.add(listener);
  c.start(kOneMegabit);
  c.send(0x300, 0);  // on the wire at once
  c.bare.run_to(c.bare.events.now() + 1'000);
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

// RM0090 32.7.6: warning at 96, passive above 127, off above 255; each an interrupt where enabled.
TEST(BxCan, ErrorsRaiseWarningPassiveAndBusOffAndTheirInterrupt) {
  Can c;
  Listener listener;
  c.add(listener);
  io::FaultBook book;
  io::CanWireFaults faults(c.bare.events, book, c.can.bus(), 1, 1000.0);
  c.start(kOneMegabit);
  book.add(
      {.number = 1, .kind = io::FaultKind::can_bit_error, .start_ns = 0, .end_ns = 100'000'000});
  put(c.can, IER, 1u << 15 | 1u << 8 | 1u << 9 | 1u << 10);
  c.send(0x123);
  std::vector<std::uint32_t> raised;  // ESR's flags at each interrupt
  while (c.bare.events.now() < 5'000'000) {
    c.bare.run_to(c.bare.events.now() + 10'000);
    if (!c.bare.interrupts.lines[22]) continue;
    EXPECT_NE(get(c.can, MSR) & 4, 0u);
    raised.push_back(get(c.can, ESR) & 7);
    put(c.can, MSR, 4);
  }
  EXPECT_EQ(raised, (std::vector<std::uint32_t>{1, 3, 7}));
  EXPECT_TRUE(get(c.can, ESR) >> 4 & 7);
  EXPECT_EQ(get(c.can, TSR) & 9, 8u);  // TERR, and the request stands
}

// 32.7.6: with ABOM by itself, without it after INRQ has been set and cleared; 128 times 11 bits.
TEST(BxCan, ComesBackFromBusOffAlone_OrThroughInitialisation) {
  for (const bool automatic : {true, false}) {
    Can c;
    Listener listener;
    c.add(listener);
    io::FaultBook book;
    io::CanWireFaults faults(c.bare.events, book, c.can.bus(), 1, 1000.0);
    c.start(kOneMegabit);
    put(c.can, MCR, automatic ? 64 : 0);
    book.add(
        {.number = 1, .kind = io::FaultKind::can_bit_error, .start_ns = 0, .end_ns = 3'000'000});
    c.send(0x123);
    while ((get(c.can, ESR) & 4) == 0 && c.bare.events.now() < 4'000'000) {
      c.bare.run_to(c.bare.events.now() + 1'000);
    }
    const Nanoseconds off = c.bare.events.now();
    ASSERT_LT(off, 2'900'000);
    c.bare.run_to(off + 1'300'000);
    EXPECT_NE(get(c.can, ESR) & 4, 0u);
    c.bare.run_to(off + 3'000'000);
    EXPECT_EQ(get(c.can, ESR) & 4, automatic ? 0u : 4u);
    if (!automatic) {
      put(c.can, MCR, 1);
      EXPECT_EQ(get(c.can, MSR) & 1, 1u);
      put(c.can, MCR, 0);
      c.bare.run_to(off + 3'000'000 + 1'407'000);
      EXPECT_NE(get(c.can, ESR) & 4, 0u);
      c.bare.run_to(off + 3'000'000 + 1'409'000);
      EXPECT_EQ(get(c.can, ESR) & 4, 0u);
    }
    c.bare.run_to(off + 8'000'000);
    EXPECT_EQ(listener.frames.size(), 1u);
    EXPECT_EQ(get(c.can, ESR), 0u);
  }
}

TEST(BxCan, ArbitrationLostIsShownAndWithNartEndsTheRequest) {
  for (const bool once : {false, true}) {
    Can c;
    Listener listener;
    io::CanStation& station = c.add(listener);
    c.start(kOneMegabit);
    put(c.can, MCR, once ? 16 : 0);
    listener.own.id = 0x100;
    listener.wants = true;
    c.can.bus().request(station);
    c.send(0x200);
    c.bare.run_to(c.bare.events.now() + 60'000);
    EXPECT_EQ(get(c.can, TSR) & 0xF, once ? 5u : 4u);
    EXPECT_EQ(get(c.can, RI0R) >> 21, 0x100u);  // it listens on
    c.bare.run_to(c.bare.events.now() + 200'000);
    EXPECT_EQ(listener.frames.size(), once ? 0u : 1u);
    EXPECT_EQ(get(c.can, TSR) & 0xF, once ? 5u : 3u);
  }
}

TEST(BxCan, SilentItHearsAndNeitherAcknowledgesNorSends) {
  Can c;
  Listener listener;
  io::CanStation& station = c.add(listener);
  c.start(kOneMegabit | 1u << 31);
  listener.own.id = 0x155;
  listener.wants = true;
  c.can.bus().request(station);
  c.send(0x001);
  c.bare.run_to(c.bare.events.now() + 500'000);
  EXPECT_TRUE(listener.wants);  // nobody acknowledged
  EXPECT_TRUE(listener.frames.empty());
  Listener third;
  c.add(third);
  c.bare.run_to(c.bare.events.now() + 1'000'000);
  EXPECT_FALSE(listener.wants);
  EXPECT_EQ(get(c.can, RI0R) >> 21, 0x155u);
}

TEST(BxCan, AWrongBitRateIsSaid) {
  Can c;
  Listener listener;
  c.add(listener, 2000.0);
  c.start(kOneMegabit);
  c.bare.run_to(c.bare.events.now() + 30'000);
  c.send(0x123);
  c.bare.run_to(c.bare.events.now() + 500'000);
  ASSERT_FALSE(c.bare.findings.empty());
  EXPECT_EQ(c.bare.findings[0].what, "listener runs at 500 kbit/s, CAN1 at 1000 kbit/s");
}

TEST(BxCan, AnAbortOfWhatIsOnTheWireHoldsOnlyIfItFails) {
  Can c;
  Listener listener;
  c.add(listener);
  c.start(kOneMegabit);
  c.send(0x123);
  c.bare.run_to(c.bare.events.now() + 20'000);
  put(c.can, TSR, 0x80);
  EXPECT_EQ(get(c.can, TSR) & 1, 0u);
  c.bare.run_to(c.bare.events.now() + 100'000);
  EXPECT_EQ(get(c.can, TSR) & 3, 3u);
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
