// What a board's process is told: it comes back as it was written, and what is wrong is refused.
#include "io_bridges/board_description/board_text.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace whirl {
namespace {

Result<BoardStart> read(const std::string& pairs) {
  return read_board_text(R"({"board":"b","image":"x",)" + pairs + "}");
}

BoardStart everything() {
  BoardStart start;
  start.run = {.image = "a.elf",
               .flashed = {"cells.elf"},
               .wires = {{.device = "esc1", .fd = 7},
                         {.bus = "i2c2", .fd = 8},
                         {.bus = "can1", .fd = 9, .arbitrates = true, .far = "esc2"}},
               .seed = 18446744073709551615u,
               .gdb_port = 1234,
               .folder = "runs/1",
               .node = "fc"};
  BoardDescription& board = start.board;
  board.file = "boards/b.lua";
  board.name = "b";
  board.mcu = "stm32f405rg";
  board.hse_Hz = 24e6;
  board.lse_Hz = 32768.5;
  board.hse_start_ns = 123'456'789;
  board.hsi_error = 0.01 / 3.0;
  board.hse_error = -1e-5;
  board.boot_image = "boot.elf";
  board.start = 0x08004000;
  board.ns_per_instruction = 8;
  BoardDevice device{.name = "imu",
                     .type = "mpu6000",
                     .bus = "spi1",
                     .address = 0x29,
                     .motor = 4,
                     .place = "b.lua:7",
                     .senses = {"field_x", "field_y"}};
  device.keys = {{"cs", "PB0"},
                 {"on", true},
                 {"tenth", 0.1},
                 {"smallest", std::numeric_limits<double>::denorm_min()},
                 {"params.place", std::vector<double>{1.0 / 3.0, -0.0, 5e300}},
                 {"axes", std::vector<std::string>{"+x", "-y", "-z"}}};
  board.devices = {device, {.name = "x", .type = "y"}};
  board.pins = {{.name = "led", .pin = "PB1"},
                {.name = "scl", .pin = "PB8", .pull = "up", .bus = "i2c1.scl", .place = "b.lua:9"}};
  board.watch = {"f", "g"};
  return start;
}

TEST(BoardText, ComesBackAsItWasWritten) {
  const auto told = read_board_text(board_text(everything()));
  ASSERT_TRUE(told) << told.error().message();
  EXPECT_TRUE(told.value() == everything());
  EXPECT_EQ(board_text(told.value()), board_text(everything()));
}

// A field that the text forgets would come back as its default: each of them differs from it.
TEST(BoardText, EachKeyOfTheTextIsNeeded) {
  const auto text = nlohmann::json::parse(board_text(everything()));
  for (const auto& [key, value] : text.items()) {
    nlohmann::json without = text;
    without.erase(key);
    const auto told = read_board_text(without.dump());
    EXPECT_FALSE(told && told.value() == everything()) << key;
  }
}

TEST(BoardText, AKeyThatNobodyReadsIsRefused) {
  for (const char* pair : {R"("sync_ns":1000000)", R"("pins":[{"name":"a","colour":"red"}])"}) {
    const auto told = read(pair);
    ASSERT_FALSE(told) << pair;
    EXPECT_NE(told.error().message().find("is no key"), std::string::npos);
  }
  for (const char* entry : {R"("on":null)", R"("deep":{"a":1})", R"("mixed":[1,"a"])",
                            R"("address":"x")", R"("motor":1.5)", R"("bus":3)"}) {
    const auto told = read(std::string(R"("devices":[{"name":"d","type":"t",)") + entry + "}]");
    ASSERT_FALSE(told) << entry;
    EXPECT_NE(told.error().message().find("devices[0]."), std::string::npos);
  }
}

// A path may hold any bytes: what is no UTF-8 becomes a name that is not found, and is shown.
TEST(BoardText, IsJsonWhateverBytesThePathsHold) {
  BoardStart start = everything();
  start.run.image = "a\xFF.elf";
  EXPECT_TRUE(read_board_text(board_text(start)));
}

TEST(BoardText, WholeNumbersAreReadToTheEndOfTheirRange) {
  const auto told = read(R"("seed":18446744073709551615,"start":4294967295)");
  ASSERT_TRUE(told);
  EXPECT_EQ(told.value().run.seed, 18446744073709551615u);
  EXPECT_EQ(told.value().board.start, 4294967295u);
}

TEST(BoardText, ANumberThatDoesNotFitIsRefusedByItsKey) {
  for (const char* pair :
       {R"("seed":4777770000000001638205164046)", R"("seed":-1)", R"("start":4294967296)",
        R"("gdb_port":2147483648)", R"("gdb_port":1.5)", R"("hse_start_ns":1e300)",
        R"("hse_start_ns":-1e300)", R"("gdb_port":true)", R"("gdb_port":"1")"}) {
    const auto told = read(pair);
    ASSERT_FALSE(told) << pair;
    const std::string key = std::string(pair).substr(1, std::string(pair).find(':') - 2);
    EXPECT_NE(told.error().message().find("b: " + key + ": is not a whole number"),
              std::string::npos)
        << told.error().message();
  }
}

TEST(BoardText, ACrystalCannotStartBeforeItIsAsked) {
  EXPECT_FALSE(read(R"("hse_start_ns":-1)"));
  EXPECT_TRUE(read(R"("hse_start_ns":0)"));
}

TEST(BoardText, AnOscillatorsErrorIsWithinItsRangeAndOfOneThatIsThere) {
  for (const char* good : {R"("hsi_error":-0.05)", R"("hse_Hz":8e6,"hse_error":0.001)",
                           R"("hse_Hz":8e6,"hse_error":-0.001,"hsi_error":0.05)"}) {
    EXPECT_TRUE(read(good)) << good;
  }
  EXPECT_EQ(read(R"("hsi_error":0.01)").value().board.hsi_error, 0.01);
  for (const char* bad :
       {R"("hsi_error":0.0501)", R"("hsi_error":-0.0501)", R"("hse_Hz":8e6,"hse_error":0.00101)",
        R"("hse_Hz":8e6,"hse_error":-0.00101)", R"("hse_error":0.0001)", R"("hsi_error":"1 %")"}) {
    const auto told = read(bad);
    ASSERT_FALSE(told) << bad;
    EXPECT_NE(told.error().message().find("_error"), std::string::npos) << bad;
  }
}

}  // namespace
}  // namespace whirl
