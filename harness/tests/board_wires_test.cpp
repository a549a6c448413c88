// Boards in the place of other boards' devices: which wires a plan may have.
#include "harness/cli/board_wires.hpp"

#include <gtest/gtest.h>

namespace whirl::cli {
namespace {

// Each has an ESC on its bus, a second one, and a sensor on another kind of bus.
struct Rig {
  plan::Plan plan = plan::plan_of_one_board("rig", "rig.lua:3");
  std::vector<Node> nodes;

  explicit Rig(std::size_t boards) {
    for (std::size_t i = 0; i < boards; ++i) {
      BoardDescription board;
      board.name = "board";
      board.devices = {
          {.name = "esc1", .type = "esc_i2c", .bus = "i2c3", .address = 0x29, .motor = 1},
          {.name = "esc2", .type = "esc_i2c", .bus = "i2c3", .address = 0x2A, .motor = 2},
          {.name = "imu", .type = "mpu6000", .bus = "spi1"},
          {.name = "imu2", .type = "mpu6000", .bus = "spi1"},
          {.name = "baro", .type = "ms5611", .bus = "i2c1", .address = 0x76},
          {.name = "gps", .type = "ublox_6", .bus = "usart6"},
          {.name = "sbus", .type = "sbus", .bus = "uart4"},
          {.name = "esc3", .type = "esc_dronecan", .bus = "can2", .motor = 3},
          {.name = "esc4", .type = "esc_dronecan", .bus = "can2", .motor = 4},
          {.name = "rc", .type = "cppm", .bus = "PA10"},
          {.name = "battery", .type = "battery_sense", .bus = "PC0"},
          {.name = "current", .type = "current_sense", .bus = "PC1"}};
      nodes.push_back({std::string(1, static_cast<char>('a' + i)), board});
    }
  }
  Rig& wire(std::size_t leader, const std::string& device, std::size_t follower,
            const std::string& bus = "i2c2") {
    plan.board_wires.push_back({leader, device, follower, bus});
    return *this;
  }
  std::string refused() const {
    const auto checked = check_board_wires(plan, nodes);
    return checked ? "" : checked.error().what;
  }
};

TEST(BoardWires, AChainAndAStarAreTaken) {
  EXPECT_EQ(Rig(3).wire(0, "esc1", 1).wire(0, "esc2", 2).refused(), "");
  EXPECT_EQ(Rig(3).wire(0, "esc1", 1).wire(1, "esc1", 2).refused(), "");
}

TEST(BoardWires, BoardsThatLeadEachOtherInACircleAreRefused) {
  EXPECT_EQ(Rig(2).wire(0, "esc1", 1).wire(1, "esc1", 0).refused(),
            "wires: boards lead each other in a circle: a -> b -> a");
  const std::string three =
      Rig(4).wire(1, "esc1", 2).wire(2, "esc1", 3).wire(3, "esc1", 1).wire(1, "esc2", 0).refused();
  EXPECT_NE(three.find("in a circle: "), std::string::npos) << three;
}

TEST(BoardWires, APodPlaysSeveralMotorsControllers) {
  Rig rig(2);
  rig.nodes[1].board.devices.push_back({.name = "host", .type = "pod_parts"});
  EXPECT_EQ(rig.wire(0, "esc1", 1).wire(0, "esc2", 1, "i2c3").refused(), "");
}

TEST(BoardWires, ABoardHasOneMasterAndADeviceOneBoardInItsPlace) {
  EXPECT_EQ(Rig(3).wire(0, "esc1", 2).wire(1, "esc1", 2).refused(),
            "wires: c takes the place of devices of two boards");
  EXPECT_EQ(Rig(2).wire(0, "esc1", 1).wire(0, "esc2", 1).refused(),
            "wires: b takes the place of two motors' devices");
  EXPECT_EQ(Rig(3).wire(0, "esc1", 1).wire(0, "esc1", 2).refused(),
            "wires: two boards take the place of a.esc1");
}

TEST(BoardWires, BothEndsAreI2cOrBothSpiAndEachBusHasOneMaster) {
  EXPECT_EQ(Rig(2).wire(0, "imu", 1, "spi1").wire(0, "esc1", 1).refused(), "");
  EXPECT_EQ(Rig(2).wire(0, "imu", 1).refused(), "wires: a.imu is on spi1, the other end on i2c2");
  EXPECT_EQ(Rig(2).wire(0, "esc1", 1, "spi1").refused(),
            "wires: a.esc1 is on i2c3, the other end on spi1");
  EXPECT_EQ(Rig(2).wire(0, "imu", 1, "spi1").wire(0, "imu2", 1, "spi1").refused(),
            "wires: b.spi1 has two masters");
  EXPECT_EQ(Rig(2).wire(0, "esc1", 1).wire(0, "baro", 1).refused(),
            "wires: b.i2c2 has two masters");
  EXPECT_EQ(Rig(2).wire(0, "rc", 1).refused(),
            "wires: a.rc is no target on an I2C, SPI or CAN bus, and on no UART or analog pin");
  EXPECT_EQ(Rig(2).wire(0, "esc7", 1).refused(), "wires: board has no device 'esc7'");
}

TEST(BoardWires, AnAnalogPinIsJoinedToADacsChannelOfItsOwn) {
  EXPECT_EQ(Rig(2).wire(0, "battery", 1, "dac1").wire(0, "current", 1, "dac2").refused(), "");
  EXPECT_EQ(Rig(2).wire(0, "battery", 1, "usart6").refused(),
            "wires: a.battery is on PC0, the other end on usart6");
  EXPECT_EQ(Rig(2).wire(0, "rc", 1, "dac1").refused(),
            "wires: a.rc is no target on an I2C, SPI or CAN bus, and on no UART or analog pin");
  EXPECT_EQ(Rig(2).wire(0, "battery", 1, "dac1").wire(0, "current", 1, "dac1").refused(),
            "wires: b.dac1 has two masters");
}

TEST(BoardWires, AUartIsJoinedToOneUart) {
  EXPECT_EQ(Rig(2).wire(0, "gps", 1, "usart6").wire(0, "sbus", 1, "usart2").refused(), "");
  EXPECT_EQ(Rig(2).wire(0, "gps", 1).refused(), "wires: a.gps is on usart6, the other end on i2c2");
  EXPECT_EQ(Rig(2).wire(0, "imu", 1, "uart4").refused(),
            "wires: a.imu is on spi1, the other end on uart4");
  EXPECT_EQ(Rig(2).wire(0, "gps", 1, "usart6").wire(0, "sbus", 1, "usart6").refused(),
            "wires: b.usart6 has two masters");
  for (const plan::PlanWire& line :
       {plan::PlanWire{{0, 6}, {1, 1}}, plan::PlanWire{{0, 1}, {1, 2}}}) {
    Rig rig(2);
    rig.plan.wires.push_back(line);
    rig.wire(0, "gps", 1, "usart2");
    const std::string both = line.a.uart == 6 ? "a.usart6" : "b.usart2";
    EXPECT_EQ(rig.refused(), "wires: " + both + " has two wires");
  }
}

TEST(BoardWires, ManyBoardsShareACanThatOneArbitrates) {
  EXPECT_EQ(Rig(3).wire(0, "esc3", 1, "can1").wire(0, "esc4", 2, "can1").refused(), "");
  EXPECT_EQ(Rig(3).wire(0, "can1", 1, "can1").wire(0, "can1", 2, "can2").refused(), "");
  EXPECT_EQ(Rig(3).wire(0, "esc3", 1, "can1").wire(0, "can2", 2, "can1").refused(), "");
  EXPECT_EQ(Rig(3).wire(0, "esc3", 1, "can1").wire(0, "esc1", 2).refused(), "");
}

TEST(BoardWires, ACanHasOneArbiterAndAControllerOneBus) {
  EXPECT_EQ(Rig(2).wire(0, "esc3", 1).refused(), "wires: a.esc3 is on can2, the other end on i2c2");
  EXPECT_EQ(Rig(2).wire(0, "esc1", 1, "can1").refused(),
            "wires: a.esc1 is on i2c3, the other end on can1");
  EXPECT_EQ(Rig(2).wire(0, "can", 1, "can1").refused(), "wires: board has no device 'can'");
  EXPECT_EQ(Rig(3).wire(0, "can1", 2, "can1").wire(1, "can1", 2, "can1").refused(),
            "wires: c takes the place of devices of two boards");
  EXPECT_EQ(Rig(2).wire(0, "can1", 1, "can1").wire(0, "can2", 1, "can1").refused(),
            "wires: a and b share a CAN bus and more");
  EXPECT_EQ(Rig(2).wire(0, "can1", 1, "can1").wire(0, "esc1", 1).refused(),
            "wires: a and b share a CAN bus and more");
  EXPECT_EQ(Rig(2).wire(0, "esc3", 1, "can1").wire(0, "esc4", 1, "can2").refused(),
            "wires: a and b share a CAN bus and more");
  EXPECT_EQ(Rig(3).wire(0, "can1", 1, "can1").wire(1, "can1", 2, "can1").refused(),
            "wires: b.can1 is part of a's bus");
  EXPECT_EQ(Rig(2).wire(0, "can1", 1, "can1").wire(1, "can2", 0, "can2").refused(),
            "wires: boards lead each other in a circle: a -> b -> a");
}

TEST(BoardWires, ACanWithoutADevicesPlaceIsArbitratedWhereItBegins) {
  Rig rig(3);
  rig.wire(0, "can1", 1, "can2").wire(0, "esc3", 2, "can1");
  std::vector<cli::Setup> setups;
  for (std::size_t i = 0; i < 3; ++i) {
    setups.push_back({rig.plan, i, rig.nodes[i].board, "", "", ""});
  }
  const auto links = join_boards(rig.plan, rig.nodes, setups);
  ASSERT_TRUE(links) << links.error().message();
  EXPECT_EQ(links.value().size(), 2u);
  ASSERT_EQ(setups[0].wires.size(), 2u);
  const WireEnd &there = setups[0].wires[0], &place = setups[0].wires[1];
  EXPECT_EQ(there.device + "|" + there.bus + "|" + there.far, "|can1|b");
  EXPECT_TRUE(there.arbitrates);
  EXPECT_EQ(place.device, "esc3");
  EXPECT_FALSE(place.arbitrates);
  ASSERT_EQ(setups[1].wires.size(), 1u);
  EXPECT_EQ(setups[1].wires[0].bus, "can2");
  EXPECT_FALSE(setups[1].wires[0].arbitrates);
  EXPECT_EQ(setups[1].motor, 0);
  EXPECT_EQ(setups[2].motor, 3);
  note_joined(rig.plan, rig.nodes);
  EXPECT_EQ(rig.nodes[1].joined.at("can2"), "a/can1");
  EXPECT_EQ(rig.nodes[2].joined.at("can1"), "a/can2");
  EXPECT_TRUE(rig.nodes[0].joined.empty());
}

TEST(BoardWires, EachBoardGetsItsEndOfOneMemory) {
  Rig rig(3);
  rig.wire(0, "esc2", 2);
  std::vector<cli::Setup> setups;
  for (std::size_t i = 0; i < 3; ++i) {
    setups.push_back({rig.plan, i, rig.nodes[i].board, "", "", ""});
  }
  const auto links = join_boards(rig.plan, rig.nodes, setups);
  ASSERT_TRUE(links) << links.error().message();
  ASSERT_EQ(links.value().size(), 1u);
  ASSERT_EQ(setups[0].wires.size(), 1u);
  ASSERT_EQ(setups[2].wires.size(), 1u);
  EXPECT_TRUE(setups[1].wires.empty());
  EXPECT_EQ(setups[0].wires[0].device, "esc2");
  EXPECT_EQ(setups[2].wires[0].device, "");
  EXPECT_EQ(setups[2].wires[0].bus, "i2c2");
  EXPECT_EQ(setups[0].wires[0].fd, setups[2].wires[0].fd);
  EXPECT_FALSE(setups[2].wires[0].shared);
  EXPECT_EQ(setups[2].motor, 2);
  ASSERT_EQ(setups[0].far.size(), 1u);
  EXPECT_EQ(setups[0].far[0].node, 2u);
  EXPECT_EQ(setups[0].far[0].motor, 2);
}

// So the one that follows sees all of it in one order.
TEST(BoardWires, WhatJoinsTheSameTwoBoardsIsOneMemoryWithAPortForEachBus) {
  Rig rig(2);
  rig.wire(0, "imu", 1, "spi1").wire(0, "esc1", 1);
  std::vector<cli::Setup> setups;
  for (std::size_t i = 0; i < 2; ++i) {
    setups.push_back({rig.plan, i, rig.nodes[i].board, "", "", ""});
  }
  const auto links = join_boards(rig.plan, rig.nodes, setups);
  ASSERT_TRUE(links) << links.error().message();
  ASSERT_EQ(links.value().size(), 1u);
  for (const cli::Setup& setup : setups) {
    ASSERT_EQ(setup.wires.size(), 2u);
    EXPECT_EQ(setup.wires[0].fd, setup.wires[1].fd);
    EXPECT_EQ(setup.wires[0].port, 0);
    EXPECT_EQ(setup.wires[1].port, 1);
  }
  EXPECT_EQ(setups[1].wires[0].bus, "spi1");
  EXPECT_TRUE(setups[1].wires[0].shared);
}

}  // namespace
}  // namespace whirl::cli
