// A stick of our own make, played in memory: its file, its axes and buttons as sticks and switches, and what is recorded.
#include "harness/live/pilot_stick.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"
#include "io_bridges/hid/emulated/memory_hid_port.hpp"
#include "io_bridges/hid/tests/played_stick.hpp"

namespace whirl::live {
namespace {

const auto kExact = stated(1e-12, "tenths of a percent");

constexpr const char* kFile =
    R"(return { stick = "played", vendor = 0x1209, product = 1, serial = "S1",
  axes = { roll = { axis = 1, min = 0, centre = 512, max = 1023, dead_zone = 32 },
           pitch = { axis = 2, min = 0, centre = 512, max = 1023, reversed = true },
           thrust = { axis = 3, min = -100, max = 100 } },
  arm = 1, modes = { 2, 3 } })";

Result<StickMap> read(const std::string& text) {
  const ScratchFolder folder;
  const std::string path = folder.file("stick.lua");
  std::ofstream(path) << text;
  return read_stick(path);
}

struct Bench {
  PilotStick start(const std::string& text = kFile) {
    auto started = PilotStick::start(std::make_unique<io::MemoryHidPort>(queue, stick, cable),
                                     read(text).value());
    return std::move(started.value());
  }
  io::EventQueue queue;
  io::PlayedStick stick;
  io::HidCable cable;
};

TEST(PilotStick, AxesAreSticksAndButtonsSwitches) {
  Bench bench;
  PilotStick pilot = bench.start();
  request::Sticks sticks = pilot.read();
  EXPECT_TRUE(near(sticks.thrust.value(), 0.0, kExact)) << "before it has said anything";
  EXPECT_FALSE(sticks.yaw.has_value());
  bench.stick.move(1023, 1023, 0);
  sticks = pilot.read();
  EXPECT_TRUE(near(sticks.roll.value(), 1.0, kExact));
  EXPECT_TRUE(near(sticks.pitch.value(), -1.0, kExact));
  EXPECT_TRUE(near(sticks.thrust.value(), 0.5, kExact));
  EXPECT_EQ(sticks.mode, 1);
  EXPECT_EQ(sticks.arm, false);
  bench.stick.move(540, 512, 100, 0b001);
  sticks = pilot.read();
  EXPECT_TRUE(near(sticks.roll.value(), 0.0, kExact));
  EXPECT_EQ(sticks.arm, true);
  EXPECT_EQ(pilot.read().arm, true) << "held down it turns once";
  bench.stick.move(700, 512, 100, 0b010);
  sticks = pilot.read();
  EXPECT_EQ(sticks.arm, true);
  EXPECT_EQ(sticks.mode, 1);
  EXPECT_TRUE(near(sticks.roll.value(), 0.326, kExact));  // (700 - 512 - 32) / (1023 - 512 - 32)
  bench.stick.move(512, 512, 100, 0b101);
  sticks = pilot.read();
  EXPECT_EQ(sticks.arm, false);
  EXPECT_EQ(sticks.mode, 2);
}

TEST(PilotStick, OnePulledIsATransmitterThatIsOff) {
  Bench bench;
  PilotStick pilot = bench.start();
  bench.cable.plugged = false;
  EXPECT_FALSE(pilot.read().transmitter_on);
}

TEST(PilotStick, AFileThatFitsNoDeviceIsRefused) {
  Bench bench;
  auto map = read(kFile).value();
  map.arm = 77;
  EXPECT_FALSE(PilotStick::start(
                   std::make_unique<io::MemoryHidPort>(bench.queue, bench.stick, bench.cable), map)
                   .ok());
  EXPECT_FALSE(read("return { stick = 'x', vendor = 1, product = 2, axes = {} }").ok());
  EXPECT_FALSE(
      read("return { stick = 'x', vendor = 1, product = 2, axes = { thrust = { axis = 1, min = 5, "
           "max = 5 } } }")
          .ok());
}

}  // namespace
}  // namespace whirl::live
