// Board files: what reaches the board's process, and each mistake in one sentence.
#include "harness/catalogue/board_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"

namespace whirl {
namespace {

Result<BoardDescription> read(const std::string& keys) {
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
TEST(BoardFile, ACrystalStartsAfterTwoMillisecondsUnlessTheFileKnowsBetter) {
  EXPECT_EQ(read("").value().hse_start_ns, 2'000'000);
  const BoardDescription quick = read(R"(hse_start = "0.2 ms")").value();
  EXPECT_EQ(quick.hse_start_ns, 200'000);
  EXPECT_EQ(quick.timing_profile(), "CPU cycles (+-10 %), crystal ready after 0.2 ms");
}

TEST(BoardFile, TimePassesByCyclesUnlessTheFileFixesIt) {
  EXPECT_EQ(read("").value().ns_per_instruction, 0);
  EXPECT_EQ(read(R"(timing = "cycles")").value().ns_per_instruction, 0);
  const BoardDescription fixed = read(R"(timing = "8 ns")").value();
  EXPECT_EQ(fixed.ns_per_instruction, 8);
  EXPECT_EQ(fixed.timing_profile(), "8 ns per instruction, crystal ready after 2 ms");
  EXPECT_NE(complaint(R"(timing = "8 instructions")").find("timing"), std::string::npos);
}

TEST(BoardFile, OscillatorsAreWhatTheySayUnlessTheFileKnowsBetter) {
  EXPECT_EQ(read("").value().hsi_error, 0.0);
  EXPECT_EQ(read("").value().hse_error, 0.0);
  const BoardDescription off = read(R"(hsi_error = "-1 %", hse_error = "50 ppm")").value();
  EXPECT_TRUE(near(off.hsi_error, -0.01, round_off(2, 0.01)));
  EXPECT_TRUE(near(off.hse_error, 5e-5, round_off(2, 5e-5)));
  EXPECT_EQ(off.timing_profile(),
            "CPU cycles (+-10 %), crystal ready after 2 ms, +50 ppm off, HSI -1 % off");
}

TEST(BoardFile, PinsCarryTheirResistorAndTheirBus) {
  const BoardDescription board =
      read(R"(pins = { { name = "c", pin = "PB8", bus = "i2c1.scl", pull = "up" },
                                       { name = "d", pin = "PB9" } })")
          .value();
  EXPECT_EQ(board.pins[0].bus, "i2c1.scl");
  EXPECT_EQ(board.pins[0].pull, "up");
  EXPECT_EQ(board.pins[1].pull, "");
}

TEST(BoardFile, ABootLoaderLiesBesideTheFileAndTheStartIsAnAddress) {
  const BoardDescription board = read(R"(boot_image = "boot.elf", start = 0x08004000)").value();
  EXPECT_NE(board.boot_image.find("/boot.elf"), std::string::npos);
  EXPECT_EQ(board.start, 0x08004000u);
}

TEST(BoardFile, AnImageLiesBesideTheFile) {
  const BoardDescription board =
      read(R"(devices = { { name = "e", type = "eeprom_24xx", bus = "i2c2", address = 0x50,
                            image = "blank.bin" } })")
          .value();
  const std::string image = std::get<std::string>(*board.devices[0].value("image"));
  EXPECT_EQ(image, board.file.substr(0, board.file.rfind('/') + 1) + "blank.bin");
  EXPECT_NE(complaint(R"(devices = { { name = "e", type = "eeprom_24xx", bus = "i2c2",
                                       address = 0x50, image = "" } })")
                .find("no path"),
            std::string::npos);
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
  EXPECT_NE(complaint("devices = { { name = \"d\\xC3\", type = \"serial\", bus = \"usart1\", baud "
                      "= \"9600 baud\" } }")
                .find("UTF-8"),
            std::string::npos);
  EXPECT_NE(complaint("pins = { { name = \"p\\x80\", pin = \"PB1\" } }").find("UTF-8"),
            std::string::npos);
  for (const char* key : {"board", "mcu"}) {
    EXPECT_NE(complaint(std::string(key) + " = \"b\\xFF\"").find("UTF-8"), std::string::npos)
        << key;
  }
}

// A limit is met, and what lies just beyond it is refused by its key.
TEST(BoardFile, EachLimitBelongsToItsRange) {
  struct Edge {
    std::string key, inside, outside;
  };
  for (const auto& [hse, wrong] : {std::pair{"50 MHz", false}, {"50.1 MHz", true}}) {
    // The key is in the table already: the later one counts.
    EXPECT_EQ(complaint(std::string("hse = '") + hse + "'").find("hse") != std::string::npos,
              wrong);
  }
  const Edge kEdges[] = {{"lse", "'0 Hz'", "'-0.5 Hz'"},
                         {"hse_start", "'1 us'", "'0.995 us'"},
                         {"hse_start", "'1 s'", "'1.005 s'"},
                         {"start", "0", "-1"},
                         {"start", "0xFFFFFFFF", "0x100000000"},
                         {"timing", "'1 ns'", "'0.995 ns'"},
                         {"timing", "'512 ns'", "'1024 ns'"},
                         {"timing", "'16 ns'", "'15 ns'"},
                         {"hsi_error", "'5 %'", "'5.01 %'"},
                         {"hsi_error", "'-5 %'", "'-5.01 %'"},
                         {"hse_error", "'1000 ppm'", "'1001 ppm'"},
                         {"hse_error", "'-1000 ppm'", "'-1001 ppm'"},
                         {"hse_error", "'0.1 %'", "'8 MHz'"}};
  for (const Edge& edge : kEdges) {
    EXPECT_EQ(complaint(edge.key + " = " + edge.inside), "");
    EXPECT_NE(complaint(edge.key + " = " + edge.outside).find(edge.key), std::string::npos)
        << edge.key << " = " << edge.outside;
  }
  const Edge kOfDevices[] = {{"baud", "'50 baud'", "'49.9 baud'"},
                             {"baud", "'12e6 baud'", "'12.1e6 baud'"},
                             {"address", "0x08", "0x07"},
                             {"address", "0x77", "0x78"},
                             {"motor", "1", "0"},
                             {"motor", "12", "13"}};
  for (const Edge& edge : kOfDevices) {
    const auto with = [&](const std::string& value) {
      const bool serial = edge.key == "baud";
      std::string keys =
          serial ? "type = 'serial', bus = 'usart1'" : "type = 'esc_i2c', bus = 'i2c1'";
      if (!serial) keys += edge.key == "motor" ? ", address = 9" : ", motor = 1";
      return complaint("devices = { { name = 'd', " + keys + ", " + edge.key + " = " + value +
                       " } }");
    };
    EXPECT_EQ(with(edge.inside), "");
    EXPECT_NE(with(edge.outside).find(edge.key), std::string::npos) << edge.outside;
  }
}

TEST(BoardFile, WhatItSaysInSIIsExact) {
  EXPECT_EQ(read("").value().start, 0u);
  EXPECT_EQ(read("start = 0xFFFFFFFF").value().start, 0xFFFFFFFFu);
  EXPECT_EQ(read("timing = '512 ns'").value().ns_per_instruction, 512);
  EXPECT_NE(complaint("timing = '7.6 ns'").find("a power of two"), std::string::npos);
  EXPECT_EQ(read("lse = '0.5 Hz'").value().lse_Hz, 0.5);
  EXPECT_EQ(read("hse_start = '5 us'").value().hse_start_ns, 5'000);
}

TEST(BoardFile, APinIsOneDevicesHoweverTheyNameIt) {
  const std::string sensor =
      R"({ name = "a", type = "mpu6000", bus = "spi1", cs = "PB0", int = "PC5" })";
  const std::string level =
      R"({ name = "a", type = "volts", bus = "PA0", params = { volts = "1 V" } })";
  struct Pair {
    std::string first, second, pin;
  };
  const Pair kPairs[] = {
      {level, R"({ name = "b", type = "volts", bus = "PA0", params = { volts = "1 V" } })", "PA0"},
      {level, R"({ name = "b", type = "pulse_source", bus = "PA0", motor = 1 })", "PA0"},
      {level, R"({ name = "b", type = "jumper", bus = "pins", cs = "PA1", int = "PA0" })", "PA0"},
      {sensor, R"({ name = "b", type = "mpu6000", bus = "spi1", cs = "PC5", int = "PC4" })", "PC5"},
      {sensor, R"({ name = "b", type = "mpu6000", bus = "spi1", cs = "PB1", int = "PC5" })", "PC5"},
      {sensor, R"({ name = "b", type = "mpu6000", bus = "spi1", cs = "PB1", int = "PB0" })", "PB0"},
      {sensor, R"({ name = "b", type = "jumper", bus = "pins", cs = "PA1", int = "PB0" })", "PB0"},
  };
  for (const auto& [first, second, pin] : kPairs) {
    for (const std::string& both : {first + ", " + second, second + ", " + first}) {
      EXPECT_NE(complaint("devices = { " + both + " }").find("are on one pin, " + pin),
                std::string::npos)
          << both;
    }
  }
  // Two that no pin joins, and the third pair of three.
  EXPECT_EQ(
      complaint("devices = { " + level +
                R"(, { name = "b", type = "volts", bus = "PA1", params = { volts = "1 V" } } })"),
      "");
  EXPECT_NE(complaint(R"(devices = { { name = "x", type = "jumper", cs = "PA1", int = "PA2" },
      { name = "y", type = "jumper", cs = "PA1", int = "PA3" },
      { name = "y", type = "jumper", cs = "PA1", int = "PA4" } })")
                .find("two devices are called 'y'"),
            std::string::npos);
}

TEST(BoardFile, AResistorPullsUpOrDown) {
  EXPECT_EQ(complaint(R"(pins = { { name = "c", pin = "PB8", pull = "down" } })"), "");
  EXPECT_NE(complaint(R"(pins = { { name = "c", pin = "PB8", pull = "sideways" } })").find("pull"),
            std::string::npos);
}

TEST(BoardFile, WhatPlansCouldNotSpeakOfIsNoName) {
  const auto said = [](const std::string& name) {
    return complaint("devices = { { name = '" + name +
                     "', type = 'volts', bus = 'PA1', params = { volts = '1 V' } } }");
  };
  EXPECT_EQ(said("left level"), "");
  EXPECT_NE(said("a/b").find("devices[1].name: has a '/'"), std::string::npos) << said("a/b");
  EXPECT_NE(said("a\\nb").find("devices[1].name: has a '/' or what no line shows"),
            std::string::npos);
  EXPECT_NE(said("esc").find("'esc' means every ESC of a board"), std::string::npos);
  EXPECT_NE(complaint("watch = { '' }").find("watch: has an empty name"), std::string::npos);
  EXPECT_NE(complaint("pins = { { name = 'a/b', pin = 'PB8' } }").find("pins[1].name: has a '/'"),
            std::string::npos);
}

TEST(BoardFile, KeysThatCannotStandTogetherAreRefused) {
  EXPECT_NE(complaint("devices = { { name = 'a', type = 'jumper', cs = 'PA1', int = 'PA1' } }")
                .find("devices[1].int: cs is PA1, too"),
            std::string::npos);
  const auto stage = [](const std::string& shunt) {
    return complaint(
        "devices = { { name = 'a', type = 'power_stage', motor = 1, bus = 'pins', params = { "
        "shunt = { " +
        shunt + " } } } }");
  };
  EXPECT_EQ(stage("gain = '5 %'"), stage("gain_error = '5 %'"));
  EXPECT_NE(stage("gain = '5 %', gain_error = '1 %'")
                .find("params.shunt.gain_error: says what params.shunt.gain says (one of the two)"),
            std::string::npos)
      << stage("gain = '5 %', gain_error = '1 %'");
}

TEST(BoardFile, EachEntryKnowsItsLine) {
  const auto board = read(
      "\npins = { { name = 'led', pin = 'PB8' } },\ndevices = {\n"
      "{ name = 'a', type = 'jumper', cs = 'PA1', int = 'PA2' } }");
  ASSERT_TRUE(board) << board.error().message();
  EXPECT_TRUE(board.value().pins[0].place.ends_with("b.lua:2")) << board.value().pins[0].place;
  EXPECT_TRUE(board.value().devices[0].place.ends_with("b.lua:4"));
}

// However often a key's word stands in the file.
TEST(BoardFile, AMistakeIsToldWithItsLineAndWithWhatThereIs) {
  const auto said = [](const std::string& second) {
    const std::string text = complaint(
        "devices = {\n{ name = 'a', type = 'serial', bus = 'usart1', baud = '9600 baud' },\n" +
        second + " }");
    const auto file = text.find("b.lua");
    return file == std::string::npos ? text : text.substr(file);
  };
  EXPECT_EQ(
      said("{ name = 'b',\n type = 'toaster' }"),
      "b.lua:4: devices[2].type: unknown type 'toaster' (use one of mpu6000, ms5611, "
      "hmc5883l, sd_card, eeprom_24xx, battery_sense, current_sense, esc_i2c, esc_dronecan, "
      "mpu6000_dronecan, ms5611_dronecan, hmc5883l_dronecan, ublox_m8_dronecan, battery_dronecan, "
      "ublox_6, ublox_m8, cppm, sbus, mavlink_link, serial, i2c_master, can_port, "
      "pod_replay, pod_host, pod_parts, power_stage, "
      "pulse_source, volts, jumper)");
  EXPECT_EQ(said("{ name = 'b', type = 'serial', bus = 'usart2', baud = '1 baud' }"),
            "b.lua:3: devices[2].baud: 1 baud is outside 50..1.2e+07 baud");
  EXPECT_EQ(said("{ name = 'b', type = 'serial', bus = 'usart2', baud = 'fast' }").substr(0, 26),
            "b.lua:3: devices[2].baud: ");
  EXPECT_EQ(said("{ name = 'b', type = 'serial', bus = 'usart2' }"),
            "b.lua:3: devices[2].baud: is missing: a serial needs it (of the UART, baud)");
  EXPECT_EQ(said("{ name = 'b', type = 'serial', bus = 'usart1', baud = '9600 baud' }"),
            "b.lua:3: devices[2].bus: a and b share one bus, usart1");
  EXPECT_EQ(said("{ name = 'b', type = 'i2c_master', bus = 'i2c1', params = { rate = '1 kHz',\n"
                 "  colour = 'red' } }"),
            "b.lua:4: devices[2].params.colour: is no key of the type i2c_master (it has name, "
            "type, bus, params.rate)");
  EXPECT_EQ(said("{ name = 'b', type = 'i2c_master', bus = 'i2c1', params = 'fast' }"),
            "b.lua:3: devices[2].params: is a text, not a table");
  EXPECT_EQ(said("{ name = 'b', type = 'mpu6000', bus = 'spi1', cs = 'PB0',\n"
                 "  axes = { '+x', '+y', '-z' } }"),
            "b.lua:4: devices[2].axes: +x +y -z is left-handed: no part can be soldered so");
}

}  // namespace
}  // namespace whirl
