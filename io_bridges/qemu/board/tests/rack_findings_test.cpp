// What a board's wiring does that no board should, told while it runs.
#include <gtest/gtest.h>

#include "io_bridges/qemu/board/device_rack.hpp"
#include "io_bridges/qemu/stm32/tests/chip_bench.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::board {
namespace {

constexpr std::uint32_t kGpioC = 0x40020800, kAhb1enr = 0x40023830;

struct Bench {
  void build(std::vector<BoardDevice> devices, std::vector<BoardPin> pins = {}) {
    const auto built =
        rack.build({.name = "b", .devices = std::move(devices), .pins = std::move(pins)});
    ASSERT_TRUE(built) << built.error().message();
    chip.set_bits(kAhb1enr, 0xFF);
  }
  // A pin of port C as an output at that level.
  void output(int pin, bool high) {
    chip.put(kGpioC + 0x18, 1u << (high ? pin : pin + 16));
    chip.set_bits(kGpioC, 1u << (2 * pin));
  }

  stm32::ChipBench chip;
  io::Batch happened;
  std::vector<io::Finding> found;
  DeviceRack rack{{chip.events(), chip.chip(), happened,
                   [this](const io::Finding& f) { found.push_back(f); }, 1, rack::device_types()}};
};

BoardDevice jumper(const std::string& from, const std::string& to) {
  return {.name = "jumper_" + to, .type = "jumper", .keys = {{"cs", from}, {"int", to}}};
}

BoardDevice imu(const std::string& name, const std::string& cs) {
  return {.name = name, .type = "mpu6000", .bus = "spi1", .keys = {{"cs", cs}}};
}

TEST(RackFindings, ADeviceAndTheChipOnOneWireAreNamedWithTheTime) {
  Bench b;
  b.build({jumper("PC1", "PC2")});
  b.output(1, false);
  b.output(2, false);
  ASSERT_TRUE(b.found.empty()) << b.found[0].what;
  b.chip.run(1234);
  b.output(1, true);  // the jumper drives PC2 high, the chip low
  ASSERT_EQ(b.found.size(), 1u);
  EXPECT_EQ(b.found[0].t_ns, b.chip.now());
  EXPECT_EQ(b.found[0].where, "PC2");
  EXPECT_EQ(b.found[0].what, "the microcontroller drives it low, jumper_PC2 drives it high");
  b.output(1, false);
  b.output(1, true);
  EXPECT_EQ(b.found.size(), 1u);  // once
}

TEST(RackFindings, TwoSelectedDevicesOnOneBusAreNamedOnce) {
  Bench b;
  b.build({imu("imu", "PC4"), imu("spare", "PC5")});
  b.output(4, false);
  b.output(5, true);
  b.chip.run(20'000'000);  // the parts' own start-up
  b.chip.chip().spi(1)->transfer(0xF5, 1'000'000, 3, b.chip.now());
  EXPECT_TRUE(b.found.empty()) << b.found[0].what;
  b.output(5, false);
  const io::Nanoseconds now = b.chip.now();
  b.chip.chip().spi(1)->transfer(0xF5, 1'000'000, 3, now + 20);
  b.chip.chip().spi(1)->transfer(0x00, 1'000'000, 3, now + 30);
  std::erase_if(b.found, [](const io::Finding& f) { return f.where != "spi1"; });
  ASSERT_EQ(b.found.size(), 1u);
  EXPECT_EQ(b.found[0].t_ns, now + 20);
  EXPECT_EQ(b.found[0].where, "spi1");
  EXPECT_EQ(b.found[0].what, "imu and spare are selected at once");
}

TEST(RackFindings, SticksWithoutAReceiverAreToldOnce) {
  const auto count = [](std::vector<BoardDevice> devices) {
    Bench b;
    b.build(std::move(devices));
    io::Batch sticks;
    sticks.add(io::Kind::rc_channels, 0, 5, io::RcChannels{});
    sticks.add(io::Kind::rc_channels, 0, 6, io::RcChannels{});
    for (io::Reader r(sticks.bytes()); r.next();) b.rack.on_message(r);
    return b.found.size();
  };
  EXPECT_EQ(count({}), 1u);
  EXPECT_EQ(count({{.name = "rc", .type = "cppm", .bus = "PA10"}}), 0u);
}

TEST(RackFindings, AJumperCopiesTheLevelFromTheStart) {
  Bench b;
  b.build({jumper("PC1", "PC2")}, {{.name = "low", .pin = "PC1", .pull = "down"},
                                   {.name = "high", .pin = "PC2", .pull = "up"}});
  EXPECT_FALSE(b.chip.chip().pin("PC1")->level());
  EXPECT_FALSE(b.chip.chip().pin("PC2")->level());
}

// Of I2C3 the part knows its pins, the board file does not name them.
TEST(RackFindings, ADeviceOnALineOfABusIsRefused) {
  Bench b;
  const BoardDevice esc{
      .name = "esc1", .type = "esc_i2c", .bus = "i2c3", .address = 0x29, .motor = 1};
  BoardDevice across = jumper("PC5", "PC9");
  across.place = "b.lua:7";
  const auto built = b.rack.build({.name = "b", .devices = {across, esc}});
  ASSERT_FALSE(built);
  EXPECT_EQ(built.error().message(), "b.lua:7: jumper_PC9.int: PC9 is a line of i2c3");
}

TEST(RackLog, ASpiTransactionSaysWhenEachPairHadPassed) {
  Bench b;
  b.build({imu("imu", "PC4")});
  b.output(4, true);
  b.chip.run(20'000'000);  // the part's own start-up
  b.happened.clear();
  b.output(4, false);
  const io::Nanoseconds start = b.chip.now();
  b.chip.chip().spi(1)->transfer(0xF5, 1'000'000, 3, start + 8'000);
  b.chip.chip().spi(1)->transfer(0x00, 1'000'000, 3, start + 17'000);
  b.chip.run(20'000);
  b.output(4, true);
  io::Reader r(b.happened.bytes());
  while (r.next() && r.header().kind != io::Kind::spi_transaction) continue;
  ASSERT_EQ(r.header().kind, io::Kind::spi_transaction);
  const auto head = r.as<io::BusTransaction>();
  EXPECT_EQ(head.start_ns, start);
  EXPECT_EQ(head.length, 2u);
  ASSERT_EQ(r.transferred().size(), 4u);
  EXPECT_EQ(r.transferred()[0], 0xF5);
  EXPECT_EQ(r.transferred()[3], 0x68);  // WHO_AM_I
  const auto times = r.tail_after(sizeof head + 4);
  std::uint32_t passed_ns[2];
  ASSERT_EQ(times.size(), sizeof passed_ns);
  std::memcpy(passed_ns, times.data(), sizeof passed_ns);
  EXPECT_EQ(passed_ns[0], 8'000u);
  EXPECT_EQ(passed_ns[1], 17'000u);
}

TEST(RackFindings, AFightOnALineOfAnI2cBusIsToldByTheLine) {
  Bench b;
  b.build({{.name = "esc1", .type = "esc_i2c", .bus = "i2c3", .address = 0x29, .motor = 1}});
  io::Wire& sda = b.chip.chip().i2c(3)->sda();
  sda.drive(sda.add_driver("a slave"), io::Drive::low, 5);
  EXPECT_TRUE(b.found.empty());
  sda.drive(sda.add_driver("a push-pull output"), io::Drive::high, 7);
  ASSERT_EQ(b.found.size(), 1u);
  EXPECT_EQ(b.found[0].t_ns, 7);
  EXPECT_EQ(b.found[0].where, "i2c3.sda");
  EXPECT_EQ(b.found[0].what, "a slave drives it low, a push-pull output drives it high");
}

TEST(RackFindings, AVoltageOnAPinThatIsDrivenIsSaidAtTheEnd) {
  Bench b;
  const auto level = [](const char* name, const char* pin) {
    return BoardDevice{.name = name, .type = "volts", .bus = pin, .keys = {{"params.volts", 1.5}}};
  };
  b.build({level("battery", "PC0"), level("spare", "PC1")});
  b.output(1, true);
  b.rack.run_ends(99);
  ASSERT_EQ(b.found.size(), 1u);
  EXPECT_EQ(b.found[0].where, "PC1");
  EXPECT_EQ(b.found[0].what,
            "a device puts a voltage on it, and something drove it: both cannot be");
}

TEST(RackFindings, APinThatTheBoardNamesAndNothingDrivesIsSaidAtTheEnd) {
  Bench b;
  b.build({}, {{.name = "led", .pin = "PC7"},
               {.name = "dark", .pin = "PC8"},
               {.name = "strap", .pin = "PC9", .pull = "up"}});
  b.output(7, true);
  b.rack.run_ends(99);
  ASSERT_EQ(b.found.size(), 1u);
  EXPECT_EQ(b.found[0].where, "PC8");
  EXPECT_EQ(b.found[0].what, "the board names it 'dark', but nothing ever drove it");
}

}  // namespace
}  // namespace whirl::board
