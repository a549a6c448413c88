// The harness's orders on a bus that sticks and comes free.
#include "io_bridges/rack/models/i2c_orders.hpp"

#include <gtest/gtest.h>

#include <map>

namespace whirl::rack {
namespace {

constexpr io::Nanoseconds kMs = 1'000'000;

struct Bench {
  void order(std::uint32_t number, io::Nanoseconds t_ns) {
    const std::uint8_t byte = 0x55;
    orders.add({.address = 0x29, .read = 0, .number = number}, {&byte, 1}, t_ns);
  }
  std::map<std::uint32_t, io::I2cReplyHead> replies() const {
    std::map<std::uint32_t, io::I2cReplyHead> found;
    for (io::Reader r(happened.bytes()); r.next();) {
      const auto head = r.as<io::I2cReplyHead>();
      found[head.number] = head;
    }
    return found;
  }

  io::EventQueue events;
  io::I2cBus bus{"I2C2"};
  io::Batch happened;
  I2cOrders orders{events, bus, 400e3, 2, happened};
};

TEST(I2cOrders, NoneIsSentBeforeItsTime) {
  Bench b;
  b.order(1, 5 * kMs);
  b.order(2, 9 * kMs);
  b.events.run_until(8 * kMs);
  EXPECT_EQ(b.replies().size(), 1u);
  b.events.run_until(10 * kMs);
  EXPECT_EQ(b.replies().size(), 2u);
  EXPECT_EQ(b.replies().at(2).timed_out, 0);
  EXPECT_EQ(b.replies().at(2).acked, 0);  // nobody there
}

// The line is stuck from 0 to 100 ms; an order every 10 ms. Each waits for 25 ms at most: what became
// more than 10 ms late meanwhile is given back, and the last is sent at its own time.
TEST(I2cOrders, WhatAStuckBusMadeLateIsToldAndNotSent) {
  Bench b;
  int started = 0;
  b.bus.on_transaction([&started](const io::I2cTransaction&) { ++started; });
  b.bus.sda().force(io::Drive::low, 0);
  for (std::uint32_t n = 0; n <= 15; ++n) b.order(n, n * 10 * kMs);
  b.events.run_until(100 * kMs);
  b.bus.sda().force(io::Drive::none, 100 * kMs);
  b.events.run_until(200 * kMs);
  const auto replies = b.replies();
  ASSERT_EQ(replies.size(), 16u);
  for (std::uint32_t n = 0; n <= 7; ++n) EXPECT_EQ(replies.at(n).timed_out, 1) << n;
  for (std::uint32_t n = 11; n <= 15; ++n) EXPECT_EQ(replies.at(n).timed_out, 0) << n;
  EXPECT_GE(started, 5);
  EXPECT_LE(started, 8);
}

}  // namespace
}  // namespace whirl::rack
