// Devices on CAN as another node of their bus finds them.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "io_bridges/devices/dronecan_node.hpp"
#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/esc_extended.hpp"
#include "io_bridges/rack/tests/bench_rack.hpp"

namespace whirl::rack {
namespace {

using namespace io::dronecan;

struct Bench {
  BenchRack rack;
  io::DroneCanNode flight{rack.queue, rack.can_bus, {"flight", "org.test", -1, 10, 1e6}};
  std::vector<EscStatus> told;
  std::vector<EscStatusExtended> flags;

  explicit Bench(bool by_speed = false) {
    BoardDevice esc{.name = "esc3", .type = "esc_dronecan", .bus = "can1", .motor = 3};
    if (by_speed) esc.set("params.speeds", true);
    EXPECT_NE(rack.add(esc), nullptr) << rack.error;
    flight.on<EscStatus>([this](const EscStatus& s, auto, auto) { told.push_back(s); });
    flight.on<EscStatusExtended>([this](const auto& s, auto, auto) { flags.push_back(s); });
    rack.run_ms(1);
  }
  std::vector<io::EscSetpoint> command(std::initializer_list<int> raw) {
    RawCommand message;
    for (const int one : raw) message.commands.add(static_cast<std::int16_t>(one));
    return setpoints_of(message);
  }
  std::vector<io::EscSetpoint> command_rpm(std::initializer_list<int> speeds_rpm) {
    RpmCommand message;
    for (const int one : speeds_rpm) message.speeds_rpm.add(one);
    return setpoints_of(message);
  }
  template <typename Message>
  std::vector<io::EscSetpoint> setpoints_of(const Message& message) {
    rack.posted.clear();
    flight.send(message, 5);
    rack.run_ms(1);
    std::vector<io::EscSetpoint> setpoints;
    for (io::Reader reader(rack.posted.bytes()); reader.next();) {
      if (reader.header().kind != io::Kind::esc_setpoint) continue;
      EXPECT_EQ(reader.header().port, 3);
      setpoints.push_back(reader.as<io::EscSetpoint>());
    }
    return setpoints;
  }
};

TEST(EscOnCan, TakesItsPlaceInTheCommandByFourSteps) {
  Bench b;
  for (const auto& [raw, v] : {std::pair{0, 0}, {4, 1}, {7, 1}, {4096, 1024}, {8191, 2047}}) {
    const auto setpoints = b.command({100, 200, raw, 300});
    ASSERT_EQ(setpoints.size(), 1u);
    EXPECT_EQ(setpoints[0].value, v);
    EXPECT_EQ(setpoints[0].valid, 1);
    EXPECT_LT(setpoints[0].start_ns, b.rack.queue.now());
  }
}

TEST(EscOnCan, AnArrayTooShortForItSaysZeroAndANegativeOneIsRefused) {
  Bench b;
  EXPECT_EQ(b.command({4000, 4000}).at(0).value, 0);
  const auto refused = b.command({0, 0, -4});
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_EQ(refused[0].valid, 0);
  b.rack.run_ms(100);
  ASSERT_GE(b.flags.size(), 2u);
  EXPECT_EQ(b.flags.front().flags, 0x80u);  // once
  EXPECT_EQ(b.flags.back().flags, 0u);
}

// 5000, 6000, -7000 and 8000 rpm of node 10, as pydronecan made them (facts of DroneCAN, golden vectors).
struct Quad {
  explicit Quad(bool by_speed) {
    EXPECT_NE(rack.add({.name = "port", .type = "can_port", .bus = "can1"}), nullptr);
    for (int motor = 1; motor <= 4; ++motor) {
      BoardDevice esc{.name = "esc" + std::to_string(motor),
                      .type = "esc_dronecan",
                      .bus = "can1",
                      .motor = motor};
      if (by_speed) esc.set("params.speeds", true);
      EXPECT_NE(rack.add(esc), nullptr) << rack.error;
    }
    rack.run_ms(1);
  }
  // By motor: the value, -1 where it was refused.
  std::map<int, int> told(std::initializer_list<std::initializer_list<std::uint8_t>> frames) {
    rack.posted.clear();
    for (const auto& bytes : frames) {
      io::CanMessage order;
      order.id = 0x0804070A;
      order.flags = 1;
      order.length = static_cast<std::uint8_t>(bytes.size());
      std::copy(bytes.begin(), bytes.end(), order.data);
      rack.send(io::Kind::can_order, order);
    }
    rack.run_ms(1);
    std::map<int, int> all;
    for (io::Reader reader(rack.posted.bytes()); reader.next();) {
      if (reader.header().kind != io::Kind::esc_setpoint) continue;
      const auto setpoint = reader.as<io::EscSetpoint>();
      all[reader.header().port] = setpoint.valid != 0 ? setpoint.value : -1;
    }
    return all;
  }
  BenchRack rack;
};

constexpr std::initializer_list<std::initializer_list<std::uint8_t>> kFour_speeds = {
    {0xa8, 0x26, 0x88, 0x13, 0x1c, 0x05, 0xca, 0x82}, {0x8e, 0x4d, 0x00, 0x7c, 0x62}};

// 2046 steps span 1000 to 6000 rpm: 5000 rpm is step 1636.8 above the first.
TEST(EscOnCan, TakesASpeedOfItsRangeAndRefusesWhatIsBeyond) {
  Quad quad(true);
  EXPECT_EQ(quad.told(kFour_speeds), (std::map<int, int>{{1, 1638}, {2, 2047}, {3, -1}, {4, -1}}));
}

TEST(EscOnCan, InAModeWithoutSpeedsRefusesAllOfThem) {
  Quad quad(false);
  EXPECT_EQ(quad.told(kFour_speeds), (std::map<int, int>{{1, -1}, {2, -1}, {3, -1}, {4, -1}}));
}

TEST(EscOnCan, SpeedZeroStopsInAnyModeAndTheRangeIsWhole) {
  for (const bool by_speed : {false, true}) {
    Bench b(by_speed);
    const auto value = [&](int speed_rpm) {
      const auto all = b.command_rpm({0, 0, speed_rpm});
      EXPECT_EQ(all.size(), 1u);
      return all.at(0).valid != 0 ? all[0].value : -1;
    };
    EXPECT_EQ(value(0), 0);
    EXPECT_EQ(value(999), -1);
    EXPECT_EQ(value(1000), by_speed ? 1 : -1);
    EXPECT_EQ(value(6000), by_speed ? 2047 : -1);
    EXPECT_EQ(value(6001), -1);
    b.rack.run_ms(60);
    EXPECT_EQ(b.flags.back().flags, 0x80u);                 // told as refused
    EXPECT_EQ(b.command_rpm({3000, 3000}).at(0).value, 0);  // an array too short for it
  }
}

TEST(EscOnCan, TellsItsStateTwentyTimesASecond) {
  Bench b;
  io::BodyMotion motion;
  motion.bus_voltage_V = 15.5;
  b.rack.send(motion);
  io::EscState state;
  state.bus_current_A = -0.25;
  state.speed_rpm = 4321.4;
  state.flags = 3;
  b.rack.send(io::Kind::esc_state, state);
  b.rack.run_ms(1000);
  ASSERT_GE(b.told.size(), 19u);
  EXPECT_LE(b.told.size(), 21u);
  const EscStatus& last = b.told.back();
  EXPECT_EQ(last.index, 2);
  EXPECT_EQ(last.speed_rpm, 4321);
  EXPECT_EQ(last.voltage_V, 15.5f);
  EXPECT_EQ(last.current_A, -0.25f);
  EXPECT_TRUE(std::isnan(last.temperature_K));
  EXPECT_EQ(b.flags.back().flags, 3u);
}

// The first of those that wait is offered until it is sent, but not at the price of a more urgent one.
TEST(NodeOnCan, WhatLosesTheArbitrationLetsAMoreUrgentOneOfItsNodePass) {
  Bench b;
  io::DroneCanNode other(b.rack.queue, b.rack.can_bus, {"other", "org.test", -1, 11, 1e6});
  b.rack.run_ms(1);  // it has heard the idle bus
  std::vector<io::CanTransfer> log;
  b.rack.can_bus.on_transfer([&log](const io::CanTransfer& t) { log.push_back(t); });
  RawCommand command;
  command.commands.add(1);
  other.send(command, 10);
  for (const std::uint8_t usual : {20, 20}) b.flight.send(command, usual);
  b.rack.queue.run_until(b.rack.queue.now() + 20'000);  // the other's is on the wire
  b.flight.send(command, 5);
  b.rack.run_ms(1);
  ASSERT_EQ(log.size(), 4u);
  EXPECT_EQ(log[0].losers, 1);
  const std::uint32_t priority[] = {10, 5, 20, 20};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(log[i].frame.id >> 24, priority[i]) << i;
  EXPECT_EQ(log[2].frame.data[2] & 0x1F, 0);  // transfers of one identifier keep their order
  EXPECT_EQ(log[3].frame.data[2] & 0x1F, 1);
}

TEST(CanPort, SendsOrdersFromTheirTimeOnInTheirOrder) {
  BenchRack rack;
  ASSERT_NE(rack.add({.name = "port", .type = "can_port", .bus = "can1"}), nullptr) << rack.error;
  io::DroneCanNode other(rack.queue, rack.can_bus, {"other", "org.test", -1, 11, 1e6});
  std::vector<io::CanTransfer> log;
  rack.can_bus.on_transfer([&log](const io::CanTransfer& t) { log.push_back(t); });
  rack.run_ms(5);
  for (const std::uint32_t id : {0x300u, 0x100u}) {  // not by priority: one node, one queue
    io::CanMessage order;
    order.id = id;
    order.length = 2;
    rack.send(io::Kind::can_order, order);
  }
  rack.run_ms(1);
  ASSERT_EQ(log.size(), 2u);
  EXPECT_EQ(log[0].frame.id, 0x300u);
  EXPECT_FALSE(log[0].frame.extended);
  EXPECT_EQ(log[0].start_ns, 5'000'000);
  EXPECT_EQ(log[1].frame.id, 0x100u);
  EXPECT_EQ(log[0].sender, 0);
}

}  // namespace
}  // namespace whirl::rack
