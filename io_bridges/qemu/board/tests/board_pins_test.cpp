// Pins and devices of a board description on a real part's model: what is joined, what is refused.
#include "io_bridges/qemu/board/board_pins.hpp"

#include <gtest/gtest.h>

#include "io_bridges/board_description/board_text.hpp"
#include "io_bridges/qemu/board/device_rack.hpp"
#include "io_bridges/qemu/stm32/tests/chip_bench.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::board {
namespace {

struct RackBench {
  stm32::ChipBench bench;
  io::Batch happened;
  std::vector<std::string> found;
  DeviceRack rack{{bench.events(), bench.chip(), happened,
                   [this](const io::Finding& f) { found.push_back(f.where + ": " + f.what); }, 1,
                   rack::device_types()}};

  std::string refusal(const std::string& lists) {
    auto told = read_board_text(R"({"board":"b","mcu":"stm32f405rg","image":"x",)" + lists + "}");
    if (!told) return told.error().message();
    const auto built = rack.build(told.value().board);
    return built ? "" : built.error().message();
  }
};

std::string refusal(const std::string& lists) {
  return RackBench().refusal(lists);
}

TEST(BoardPins, APinThatThePartDoesNotHaveIsRefused) {
  EXPECT_EQ(refusal(R"("pins":[{"name":"led","pin":"PB14"}])"), "");
  for (const char* pin : {"ZZ99", "hello", "", "PB16"}) {
    const std::string text = std::string(R"("pins":[{"name":"led","pin":")") + pin + R"("}])";
    EXPECT_NE(refusal(text).find("b: pin led: the part has no pin"), std::string::npos) << pin;
  }
}

TEST(BoardPins, APullIsAResistorOnItsPin) {
  RackBench b;
  EXPECT_EQ(b.refusal(R"("pins":[{"name":"a","pin":"PC1","pull":"down"}])"), "");
  io::Wire& wire = *b.bench.chip().pin("PC1");
  EXPECT_FALSE(wire.level());
  const int driver = wire.add_driver();
  wire.drive(driver, io::Drive::high, 0);
  EXPECT_TRUE(wire.level());
  wire.drive(driver, io::Drive::none, 0);
  EXPECT_FALSE(wire.level());
  EXPECT_NE(refusal(R"("pins":[{"name":"a","pin":"PC1","pull":"sideways"}])"), "");
}

// (pin's number, level, time) of each.
std::vector<std::tuple<int, int, std::int64_t>> edges(const io::Batch& batch) {
  std::vector<std::tuple<int, int, std::int64_t>> all;
  for (io::Reader r(batch.bytes()); r.next();) {
    EXPECT_EQ(r.header().kind, io::Kind::pin_edge);
    all.emplace_back(r.header().port, r.as<io::PinEdge>().level, r.header().t_ns);
  }
  return all;
}

TEST(BoardPins, TheEdgesOfANamedPinAreLoggedAndNotThoseOfABus) {
  RackBench b;
  ASSERT_EQ(b.refusal(R"("pins":[{"name":"c","pin":"PB8","bus":"i2c1.scl"},
                                  {"name":"d","pin":"PB9","bus":"i2c1.sda"},
                                  {"name":"led","pin":"PC1","pull":"down"}])"),
            "");
  io::Wire& led = *b.bench.chip().pin("PC1");
  const int driver = led.add_driver();
  led.drive(driver, io::Drive::high, 1000);
  led.drive(driver, io::Drive::high, 2000);  // no edge
  led.drive(driver, io::Drive::low, 3000);
  io::Wire& scl = *b.bench.chip().pin("PB8");
  scl.drive(scl.add_driver(), io::Drive::low, 4000);
  using Edge = std::tuple<int, int, std::int64_t>;
  EXPECT_EQ(edges(b.happened), (std::vector<Edge>{{2, 0, 0}, {2, 1, 1000}, {2, 0, 3000}}));
}

TEST(BoardPins, ABusIsSolderedToThePinsThatTheBoardNames) {
  RackBench b;
  EXPECT_EQ(b.refusal(R"("pins":[{"name":"c","pin":"PB8","bus":"i2c1.scl"},
                                  {"name":"d","pin":"PB9","bus":"i2c1.sda"}])"),
            "");
  EXPECT_EQ(b.bench.chip().pin("PB8"), &b.bench.chip().i2c(1)->scl());
  EXPECT_EQ(b.bench.chip().pin("PB9"), &b.bench.chip().i2c(1)->sda());
  EXPECT_NE(b.bench.chip().pin("PB6"), &b.bench.chip().i2c(1)->scl());
  for (const char* half : {"i2c1.scl", "i2c9.scl", "spi1.sck", "i2c1.scl "}) {
    const std::string text =
        std::string(R"("pins":[{"name":"c","pin":"PB8","bus":")") + half + R"("}])";
    EXPECT_NE(refusal(text).find("not one of a pair"), std::string::npos) << half;
  }
}

TEST(BoardPins, TheOnlyPairOfPinsIsSolderedWithTheFirstDevice) {
  RackBench b;
  EXPECT_EQ(
      b.refusal(R"("devices":[{"name":"e","type":"esc_i2c","bus":"i2c3","address":41,"motor":1}])"),
      "");
  EXPECT_EQ(b.bench.chip().pin("PA8"), &b.bench.chip().i2c(3)->scl());
  EXPECT_EQ(b.bench.chip().pin("PC9"), &b.bench.chip().i2c(3)->sda());
}

TEST(DeviceRack, TwoDevicesOnOneAddressOrALossBeyondAllAreRefused) {
  const std::string e = R"({"name":"e","type":"esc_i2c","bus":"i2c3","address":41,"motor":1})";
  const std::string f = R"({"name":"f","type":"esc_i2c","bus":"i2c3","address":41,"motor":2})";
  EXPECT_NE(refusal(R"("devices":[)" + e + "," + f + "]").find("e and f share one address on i2c3"),
            std::string::npos);
  for (const char* loss : {"5.0", "-0.1"}) {
    const std::string radio =
        std::string(R"({"name":"r","type":"mavlink_link","bus":"usart2","params.uplink_loss":)") +
        loss + "}";
    EXPECT_NE(refusal(R"("devices":[)" + radio + "]").find("uplink_loss"), std::string::npos);
  }
}

TEST(DeviceRack, TalkOnABusWithoutDevicesIsSaidOnce) {
  RackBench b;
  ASSERT_EQ(b.refusal(R"("devices":[])"), "");
  io::I2cBus& bus = *b.bench.chip().i2c(2);
  for (int i = 0; i < 3; ++i) {
    bus.start(10 * i);
    EXPECT_FALSE(bus.address(0x29, false, 10 * i + 1));
    bus.stop(10 * i + 2);
  }
  ASSERT_EQ(b.found.size(), 1u);
  EXPECT_NE(
      b.found[0].find("i2c2: the board has no device on this bus: nobody answers address 0x29"),
      std::string::npos)
      << b.found[0];
}

}  // namespace
}  // namespace whirl::board
