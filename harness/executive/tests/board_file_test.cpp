// Board files: what reaches the board's process, and each mistake in one sentence.
#include "harness/executive/board_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "harness/base/scratch_folder.hpp"

namespace whirl {
namespace {

Result<Board> read(const std::string& keys) {
  const ScratchFolder folder;
  const std::string path = folder.file("b.lua");
  std::ofstream(path, std::ios::binary)
      << "return { board = \"b\", mcu = \"stm32f405rg\", hse = \"8 MHz\", " << keys << " }";
  return read_board(path);
}
std::string complaint(const std::string& keys) {
  const auto board = read(keys);
  return board ? "" : board.error().message();
}
nlohmann::json json_of(const Board& board) {
  return nlohmann::json::parse(board_json(board, {.image = "i.elf"}));
}

TEST(BoardFile, ACrystalStartsAfterTwoMillisecondsUnlessTheFileKnowsBetter) {
  EXPECT_EQ(json_of(read("").value())["hse_start_ns"], 2'000'000);
  const Board quick = read(R"(hse_start = "0.2 ms")").value();
  EXPECT_EQ(json_of(quick)["hse_start_ns"], 200'000);
  EXPECT_EQ(quick.timing_profile(), "CPU cycles (+-10 %), crystal ready after 0.2 ms");
}

TEST(BoardFile, TimePassesByCyclesUnlessTheFileFixesIt) {
  EXPECT_EQ(json_of(read("").value())["ns_per_instruction"], 0);
  EXPECT_EQ(json_of(read(R"(timing = "cycles")").value())["ns_per_instruction"], 0);
  const Board fixed = read(R"(timing = "8 ns")").value();
  EXPECT_EQ(json_of(fixed)["ns_per_instruction"], 8);
  EXPECT_EQ(fixed.timing_profile(), "8 ns per instruction, crystal ready after 2 ms");
  EXPECT_NE(complaint(R"(timing = "8 instructions")").find("timing"), std::string::npos);
}

TEST(BoardFile, PinsCarryTheirResistorAndTheirBus) {
  const Board board = read(R"(pins = { { name = "c", pin = "PB8", bus = "i2c1.scl", pull = "up" },
                                       { name = "d", pin = "PB9" } })")
                          .value();
  const auto pins = json_of(board)["pins"];
  EXPECT_EQ(pins[0]["bus"], "i2c1.scl");
  EXPECT_EQ(pins[0]["pull"], "up");
  EXPECT_FALSE(pins[1].contains("pull"));
}

TEST(BoardFile, ABootLoaderLiesBesideTheFileAndTheStartIsAnAddress) {
  const auto json = json_of(read(R"(boot_image = "boot.elf", start = 0x08004000)").value());
  EXPECT_NE(json["boot_image"].get<std::string>().find("/boot.elf"), std::string::npos);
  EXPECT_EQ(json["start"], 0x08004000);
}

TEST(BoardFile, WhatSharesAPinIsRefused) {
  const std::string imu =
      R"({ name = "a", type = "mpu6000", bus = "spi1", cs = "PB0", int = "PC5" })";
  const auto with = [&](const std::string& other) {
    return complaint("devices = { " + imu + ", " + other + " }");
  };
  EXPECT_EQ(with(R"({ name = "b", type = "mpu6000", bus = "spi1", cs = "PB1", int = "PC4" })"), "");
  EXPECT_NE(with(R"({ name = "b", type = "mpu6000", bus = "spi1", cs = "PB0", int = "PC4" })")
                .find("a and b are on one pin, PB0"),
            std::string::npos);
  EXPECT_NE(with(R"({ name = "b", type = "pulse_source", bus = "PC5", motor = 1 })")
                .find("on one pin, PC5"),
            std::string::npos);
  EXPECT_EQ(with(R"({ name = "b", type = "jumper", bus = "pins", cs = "PB0", int = "PA1" })"), "");
  EXPECT_NE(complaint(R"(pins = { { name = "x", pin = "PB1" }, { name = "y", pin = "PB1" } })")
                .find("listed twice"),
            std::string::npos);
  EXPECT_NE(complaint(R"(pins = { { name = "x", pin = "PB1" }, { name = "x", pin = "PB2" } })")
                .find("two pins are called so"),
            std::string::npos);
}

TEST(BoardFile, FiguresOutsideOfWhatExistsAreRefused) {
  for (const char* baud : {"1e-300 baud", "1e300 baud", "0 baud"}) {
    const std::string line =
        std::string(R"(devices = { { name = "t", type = "serial", bus = "usart1", baud = ")") +
        baud + "\" } }";
    EXPECT_NE(complaint(line).find("baud"), std::string::npos) << baud;
  }
  EXPECT_NE(complaint(R"(hse_start = "2 s")").find("hse_start"), std::string::npos);
}

// JSON is UTF-8, and a library that throws on other bytes must not end the program.
TEST(BoardFile, BytesThatAreNoUtf8AreRefused) {
  EXPECT_NE(complaint("watch = { \"f\\xFF\" }").find("UTF-8"), std::string::npos);
  EXPECT_NE(complaint("devices = { { name = \"d\\xC3\", type = \"serial\", bus = \"usart1\" } }")
                .find("UTF-8"),
            std::string::npos);
  EXPECT_NE(complaint("pins = { { name = \"p\\x80\", pin = \"PB1\" } }").find("UTF-8"),
            std::string::npos);
  const std::string text = board_json(read("").value(), {.image = "a\xFF.elf"});
  EXPECT_TRUE(nlohmann::json::accept(text));
}

}  // namespace
}  // namespace whirl
