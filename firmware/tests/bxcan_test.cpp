// The driver against the model of its block, which follows the manual and not this driver.
#include "firmware/hal/bxcan.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "io_bridges/devices/can_wire_faults.hpp"
#include "io_bridges/qemu/stm32/bxcan.hpp"
#include "io_bridges/qemu/stm32/tests/bare_chip.hpp"

namespace fw {
namespace {

namespace io = whirl::io;
using whirl::stm32::BxCan;

BxCan* block = nullptr;  // a port's registers are static

struct ModelPort {
  struct Can {
    static std::uint32_t read(std::uint32_t offset) { return block->read(offset, 4); }
    static void write(std::uint32_t offset, std::uint32_t value) { block->write(offset, value, 4); }
  };
  using Filters = Can;
  struct Lock {
    ~Lock() {}
  };
  static constexpr std::uint32_t kBitTiming = hw::bxcan::bit_timing(3, 11, 2);
  static constexpr std::uint32_t kFirstBank = 0;
  static constexpr std::size_t kRxFrames = 4, kTxFrames = 6;
  static void start() {}
};

struct Listener : io::CanNode {
  std::vector<io::CanFrame> frames;
  std::vector<io::CanFrame> to_send;
  const io::CanFrame* offered() override { return to_send.empty() ? nullptr : &to_send.front(); }
  void sent(io::Nanoseconds) override { to_send.erase(to_send.begin()); }
  void receive(const io::CanFrame& frame, io::Nanoseconds) override { frames.push_back(frame); }
};

struct Bench {
  whirl::stm32::test::BareChip bare;
  whirl::stm32::CanFilters filters{14};
  BxCan model{bare.chip(), {}, filters};
  hal::BxCan<ModelPort> can;
  Listener listener;
  io::CanStation* station;
  io::FaultBook book;
  io::CanWireFaults faults{bare.events, book, model.bus(), 1, 1000.0};

  Bench() {
    block = &model;
    station = &model.bus().join(listener, "listener", 0);
    model.bus().configure(*station, 1000.0);
    model.bus().connect(*station, 1);
    const hal::CanFilter filter{0x100, 0x1FFFFF00};
    EXPECT_EQ(can.init({&filter, 1}), Status::ok);
    run_us(20);
  }
  // The core serves a line as soon as it is up.
  void run_us(int us) {
    for (int i = 0; i < us; ++i) {
      bare.run_to(bare.events.now() + 1'000);
      for (int again = 0; again < 8; ++again) {
        if (bare.interrupts.lines[19]) can.on_transmit();
        if (bare.interrupts.lines[20]) can.on_receive();
        if (bare.interrupts.lines[22]) can.on_status();
      }
    }
  }
  static hal::CanFrame frame(std::uint32_t id, std::uint8_t first = 0) {
    hal::CanFrame f;
    f.id = id;
    f.length = 8;
    f.data = {first, 1, 2, 3, 4, 5, 6, 7};
    return f;
  }
  void hear(std::uint32_t id, std::uint8_t first = 0) {
    io::CanFrame f;
    f.id = id;
    f.extended = true;
    f.length = 2;
    f.data = {first, 0xEE};
    listener.to_send.push_back(f);
    model.bus().request(*station);
  }
};

TEST(CanDriver, FramesArriveAsTheyWereSent) {
  Bench b;
  EXPECT_EQ(b.can.send(Bench::frame(0x1ABCDE01, 0xA5)), Status::ok);
  b.run_us(300);
  ASSERT_EQ(b.listener.frames.size(), 1u);
  EXPECT_TRUE(b.listener.frames[0].extended);
  EXPECT_EQ(b.listener.frames[0].id, 0x1ABCDE01u);
  EXPECT_EQ(b.listener.frames[0].data, Bench::frame(0, 0xA5).data);
  EXPECT_EQ(b.can.counters().sent, 1u);
  EXPECT_EQ(b.can.waiting(), 0u);
}

// Frames of one identifier keep their order, whichever mailboxes they get.
TEST(CanDriver, FramesOfATransferDoNotOvertakeEachOtherAndTheUrgentGoFirst) {
  Bench b;
  for (std::uint8_t i = 0; i < 6; ++i) EXPECT_EQ(b.can.send(Bench::frame(0x300, i)), Status::ok);
  EXPECT_EQ(b.can.send(Bench::frame(0x200)), Status::ok);
  b.run_us(2'000);
  ASSERT_EQ(b.listener.frames.size(), 7u);
  std::vector<std::uint8_t> order;
  std::size_t urgent = 0;
  for (std::size_t i = 0; i < 7; ++i) {
    if (b.listener.frames[i].id == 0x300) order.push_back(b.listener.frames[i].data[0]);
    if (b.listener.frames[i].id == 0x200) urgent = i;
  }
  EXPECT_EQ(order, (std::vector<std::uint8_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(urgent, 3u);  // behind the three that were in the mailboxes
}

TEST(CanDriver, AFullQueueIsBusyAndCounted) {
  Bench b;
  for (int i = 0; i < 9; ++i) EXPECT_EQ(b.can.send(Bench::frame(0x300)), Status::ok);
  EXPECT_EQ(b.can.send(Bench::frame(0x300)), Status::busy);
  EXPECT_EQ(b.can.counters().dropped, 1u);
}

TEST(CanDriver, ReceivesWhatItsFilterLetsThrough) {
  Bench b;
  b.hear(0x123, 7);
  b.hear(0x223);
  b.hear(0x1FF, 9);
  b.run_us(1'000);
  hal::CanFrame frame;
  ASSERT_TRUE(b.can.read(frame));
  EXPECT_EQ(frame.id, 0x123u);
  EXPECT_EQ(frame.length, 2u);
  EXPECT_EQ(frame.data[0], 7u);
  ASSERT_TRUE(b.can.read(frame));
  EXPECT_EQ(frame.id, 0x1FFu);
  EXPECT_FALSE(b.can.read(frame));
}

TEST(CanDriver, AFullRingLosesTheNewestAndCounts) {
  Bench b;
  for (std::uint8_t i = 0; i < 6; ++i) b.hear(0x100, i);
  b.run_us(1'500);
  hal::CanFrame frame;
  for (std::uint8_t i = 0; i < 4; ++i) {
    ASSERT_TRUE(b.can.read(frame));
    EXPECT_EQ(frame.data[0], i);
  }
  EXPECT_FALSE(b.can.read(frame));
  EXPECT_EQ(b.can.counters().lost, 2u);
}

TEST(CanDriver, BusOffDropsWhatWaitsAndItComesBackByItself) {
  Bench b;
  b.book.add(
      {.number = 1, .kind = io::FaultKind::can_bit_error, .start_ns = 0, .end_ns = 10'000'000});
  for (int i = 0; i < 5; ++i) EXPECT_EQ(b.can.send(Bench::frame(0x300)), Status::ok);
  while (!b.can.bus_off() && b.bare.events.now() < 9'000'000) b.run_us(10);
  EXPECT_EQ(b.can.counters().bus_off, 1u);
  EXPECT_EQ(b.can.waiting(), 0u);
  EXPECT_EQ(b.can.send(Bench::frame(0x300)), Status::no_answer);
  while (b.bare.events.now() < 10'000'000) b.run_us(10);
  b.run_us(1'500);
  EXPECT_FALSE(b.can.bus_off());
  EXPECT_EQ(b.can.send(Bench::frame(0x301)), Status::ok);
  b.run_us(300);
  ASSERT_EQ(b.listener.frames.size(), 1u);
  EXPECT_EQ(b.listener.frames[0].id, 0x301u);
}

TEST(CanDriver, CancelledFramesAreNotSentLater) {
  Bench b;
  b.book.add({.number = 1, .kind = io::FaultKind::can_cut, .start_ns = 0, .end_ns = 5'000'000});
  for (int i = 0; i < 5; ++i) EXPECT_EQ(b.can.send(Bench::frame(0x300)), Status::ok);
  b.run_us(4'000);
  EXPECT_EQ(b.can.waiting(), 5u);
  EXPECT_TRUE(b.can.error_passive());
  b.can.cancel();
  b.run_us(5'000);
  EXPECT_EQ(b.can.waiting(), 0u);
  EXPECT_TRUE(b.listener.frames.empty());
}

}  // namespace
}  // namespace fw
