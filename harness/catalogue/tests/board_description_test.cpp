#include "harness/catalogue/board_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"

namespace whirl {
namespace {

Result<BoardDescription> read_text(const std::string& text) {
  const ScratchFolder folder;
  const std::string path = folder.file("board.lua");
  std::ofstream(path) << text;
  return read_board(path);
}

std::string board_with(const std::string& more) {
  return "return { board = 'b', mcu = 'stm32f405rg', hse = '24 MHz', " + more + " }";
}

constexpr const char* kDevices = R"(lse = '32768 Hz', timing = '16 ns', devices = {
  { name = 'imu', type = 'mpu6000', bus = 'spi1', cs = 'PC4', int = 'PC5', axes = { '-y', '+x', '+z' },
    params = { place = { '1 cm', '0 m', '-2 mm' }, gyroscope = { scale_error = '5 %', noise_density = 1e-4 } } },
  { name = 'esc1', type = 'esc_i2c', bus = 'i2c3', address = 0x08, motor = 1 },
  { name = 'esc2', type = 'esc_i2c', bus = 'i2c3', address = 0x77, motor = 4 },
  { name = 'far', type = 'esc_i2c', bus = 'i2c2', address = 0x77, motor = 2 },
  { name = 'radio', type = 'mavlink_link', bus = 'usart2', baud = '57600 baud' },
  { name = 'stage', type = 'power_stage', motor = 1, params = { swap_wires = true, resistance = '90 mohm' } } },
  pins = { { name = 'led', pin = 'PA15' } }, watch = { 'f', 'g' })";

TEST(BoardDescription, GivesItsDevicesByNameAndNumber) {
  const auto board = read_text(board_with(kDevices));
  ASSERT_TRUE(board) << board.error().message();
  const BoardDescription& b = board.value();
  EXPECT_EQ(b.name, "b");
  EXPECT_EQ(b.mcu, "stm32f405rg");
  EXPECT_EQ(b.hse_Hz, 24e6);
  EXPECT_EQ(b.lse_Hz, 32768.0);
  EXPECT_EQ(b.ns_per_instruction, 16);
  EXPECT_EQ(b.number("imu"), 0);
  EXPECT_EQ(b.number("radio"), 4);
  EXPECT_EQ(b.number("nobody"), -1);
  EXPECT_EQ(b.find("nobody"), nullptr);
  EXPECT_EQ(b.find("imu"), &b.devices[0]);
  EXPECT_EQ(b.find("esc2")->address, 0x77);
  EXPECT_EQ(b.find("esc2")->motor, 4);
  EXPECT_EQ(b.find("imu")->address, -1);
  EXPECT_EQ(b.find("imu")->motor, 0);
  EXPECT_EQ(b.watch_number("f"), 0);
  EXPECT_EQ(b.watch_number("g"), 1);
  EXPECT_EQ(b.watch_number("h"), -1);
}

TEST(BoardDescription, HoldsAllInSI) {
  const auto board = read_text(board_with(kDevices));
  ASSERT_TRUE(board);
  const BoardDescription& b = board.value();
  ASSERT_EQ(b.devices.size(), 6u);
  const BoardDevice& imu = b.devices[0];
  EXPECT_EQ(imu.name, "imu");
  EXPECT_EQ(imu.type, "mpu6000");
  EXPECT_EQ(imu.bus, "spi1");
  const std::map<std::string, KeyValue, std::less<>> keys = {
      {"cs", "PC4"},
      {"int", "PC5"},
      {"axes", std::vector<std::string>{"-y", "+x", "+z"}},
      {"params.place", std::vector<double>{0.01, 0.0, -0.002}},
      {"params.gyroscope.scale_error", 0.05},
      {"params.gyroscope.noise_density", 1e-4}};
  EXPECT_TRUE(imu.keys == keys);
  EXPECT_TRUE(b.devices[1].keys.empty());
  EXPECT_TRUE(b.devices[4].value("baud") == KeyValue(57600.0));
  EXPECT_TRUE(b.devices[5].value("params.swap_wires") == KeyValue(true));
  EXPECT_TRUE(b.devices[5].value("params.resistance") == KeyValue(0.09));
  ASSERT_EQ(b.pins.size(), 1u);
  EXPECT_EQ(b.pins[0].name, "led");
  EXPECT_EQ(b.pins[0].pin, "PA15");
  EXPECT_EQ(b.watch, (std::vector<std::string>{"f", "g"}));
}

TEST(BoardDescription, WithoutThemItTakesTheDefaults) {
  const auto board = read_text(board_with(""));
  ASSERT_TRUE(board) << board.error().message();
  EXPECT_EQ(board.value().ns_per_instruction, 0);
  EXPECT_EQ(board.value().lse_Hz, 0.0);
}

TEST(BoardDescription, RefusesDoublesAndWhatIsOutOfRange) {
  const auto two = [](const std::string& a, const std::string& b) {
    return read_text(board_with("devices = { { type = 'esc_i2c', " + a +
                                " }, { type = 'esc_i2c', " + b + " } }"));
  };
  const std::string other = "name = 'b', bus = 'i2c1', address = 9, motor = 2";
  struct Bad {
    Result<BoardDescription> board;
    const char* words;
  };
  const Bad kAll[] = {
      {two("name = 'a', bus = 'i2c1', address = 8, motor = 1",
           "name = 'a', bus = 'i2c2', address = 9, motor = 2"),
       "two devices are called 'a'"},
      {two("name = 'a', bus = 'i2c1', address = 9, motor = 1", other),
       "a and b share one address on i2c1"},
      {two("name = 'a', bus = 'i2c1', address = 8, motor = 2", other), "share one motor, 2"},
      {two("name = 'a', bus = 'i2c1', address = 7, motor = 1", other), "address: 0x07 is outside"},
      {two("name = 'a', bus = 'i2c1', address = 0x78, motor = 1", other), "address: 0x78"},
      {two("name = 'a', bus = 'i2c1', address = 8, motor = 0", other), "motor: 0 is outside 1..12"},
      {two("name = 'a', bus = 'i2c1', address = 8, motor = 13", other),
       "motor: 13 is outside 1..12"},
      {read_text(board_with("timing = '0.5 ns'")), "timing"},
      {read_text(board_with("timing = '2 us'")), "timing"},
      {read_text("return { board = 'b', mcu = 'm', hse = '0 Hz' }"), "hse"},
      {read_text("return { board = 'b', hse = '1 Hz' }"), "mcu"},
      {read_text("return {"), "board.lua"},
  };
  for (const Bad& bad : kAll) {
    ASSERT_FALSE(bad.board) << bad.words;
    EXPECT_NE(bad.board.error().message().find(bad.words), std::string::npos)
        << bad.board.error().message();
  }
  EXPECT_TRUE(two("name = 'a', bus = 'i2c2', address = 9, motor = 1", other));
}

}  // namespace
}  // namespace whirl
