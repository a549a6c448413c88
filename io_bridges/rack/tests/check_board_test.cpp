// Boards that cannot be built, by whoever described them: what is said of each.
#include "io_bridges/rack/check_board.hpp"

#include <gtest/gtest.h>

#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

BoardDevice serial(const std::string& name, const std::string& bus) {
  return {.name = name, .type = "serial", .bus = bus, .keys = {{"baud", 9600.0}}};
}

std::string said(const BoardDescription& board) {
  for (std::size_t i = 0; i < board.devices.size(); ++i) {
    if (auto c = check_device(board.devices[i], static_cast<int>(i), device_types())) {
      return c->key + ": " + c->what + " (" + c->cure + ")";
    }
  }
  const auto c = check_sharing(board, device_types());
  return c ? c->key + ": " + c->what : "";
}
std::string of(std::vector<BoardDevice> devices) {
  return said(BoardDescription{.devices = std::move(devices)});
}

TEST(CheckBoard, WhatIsWrongWithADeviceIsSaidWithWhatThereIs) {
  EXPECT_EQ(of({serial("t", "usart1")}), "");
  EXPECT_EQ(of({serial("", "usart1")}), "name: is empty (give it one)");
  EXPECT_EQ(
      of({{.name = "x", .type = "toaster"}}),
      "type: unknown type 'toaster' (use one of mpu6000, ms5611, hmc5883l, sd_card, eeprom_24xx, "
      "battery_sense, current_sense, esc_i2c, esc_dronecan, mpu6000_dronecan, "
      "ms5611_dronecan, hmc5883l_dronecan, ublox_m8_dronecan, battery_dronecan, ublox_6, ublox_m8, "
      "cppm, sbus, "
      "mavlink_link, serial, "
      "i2c_master, can_port, pod_replay, pod_host, pod_parts, power_stage, pulse_source, volts, "
      "jumper)");
  BoardDevice device = serial("t", "usart1");
  device.keys["colour"] = "red";
  EXPECT_EQ(of({device}),
            "colour: is no key of the type serial (it has name, type, bus, baud, params.frame, "
            "params.follows)");
  device = serial("t", "usart1");
  device.motor = 2;
  EXPECT_NE(of({device}).find("motor: is no key"), std::string::npos);
  device = serial("t", "usart1");
  device.keys.clear();
  EXPECT_EQ(of({device}), "baud: is missing: a serial needs it (of the UART, baud)");
  device.keys = {{"baud", "fast"}};
  EXPECT_EQ(of({device}), "baud: is no number ()");
  EXPECT_NE(of({serial("t", "spi1")}).find("bus: 'spi1' is no bus"), std::string::npos);
}

TEST(CheckBoard, APartOfTwoBusesHasTheKeysOfItsOwn) {
  BoardDevice baro{.name = "b", .type = "ms5611", .bus = "i2c2", .address = 0x77};
  EXPECT_EQ(of({baro}), "");
  baro.keys["cs"] = "PB0";
  EXPECT_EQ(of({baro}), "cs: is for one on spi, and this is on i2c2 (leave it out)");
  baro.bus = "spi2";
  EXPECT_EQ(of({baro}), "address: is for one on i2c, and this is on spi2 (leave it out)");
  baro.address = -1;
  EXPECT_EQ(of({baro}), "");
  baro.keys.clear();
  EXPECT_EQ(of({baro}), "cs: is missing: a ms5611 needs it (chip select, active low, pin)");
  baro.bus = "i2c2";
  EXPECT_NE(of({baro}).find("address: is missing"), std::string::npos);
  baro.bus = "usart2";
  EXPECT_EQ(of({baro}), "bus: 'usart2' is no bus for it: write it as \"i2c1\" or \"spi1\" ()");
}

TEST(CheckBoard, OneThingIsOneDevices) {
  EXPECT_EQ(of({serial("a", "usart1"), serial("b", "usart2")}), "");
  EXPECT_EQ(of({serial("a", "usart1"), serial("b", "usart1")}),
            "bus: a and b share one bus, usart1");
  const BoardDevice radio{.name = "b", .type = "mavlink_link", .bus = "uart1"};
  EXPECT_NE(of({serial("a", "usart1"), radio}).find("share one bus"), std::string::npos);
  const BoardDevice stage{.name = "stage", .type = "power_stage", .motor = 1};
  const BoardDevice level{
      .name = "v", .type = "volts", .bus = "PA1", .keys = {{"params.volts", 1.0}}};
  EXPECT_EQ(of({level, stage}), ": v and stage are on one pin, PA1");
  BoardDescription board{.devices = {level},
                         .pins = {{.name = "c", .pin = "PA1", .bus = "i2c1.scl"}}};
  EXPECT_EQ(said(board), "bus: i2c1.scl and v are on one pin, PA1");
}

}  // namespace
}  // namespace whirl::rack
