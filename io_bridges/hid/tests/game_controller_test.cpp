#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "base/near.hpp"
#include "io_bridges/hid/emulated/memory_hid_port.hpp"
#include "io_bridges/hid/game_controller.hpp"
#include "io_bridges/hid/tests/played_stick.hpp"

namespace whirl::io {
namespace {

const auto kExact = stated(1e-12, "a quotient of small whole numbers");

struct Bench {
  GameController start(std::vector<AxisCalibration> calibrations, std::int64_t silence_ns = 0) {
    auto started = GameController::start(std::make_unique<MemoryHidPort>(queue, stick, cable),
                                         std::move(calibrations), silence_ns);
    return std::move(started.value());
  }
  EventQueue queue;
  PlayedStick stick;
  HidCable cable;
};

// Appendix E.10 of HID 1.11 (mouse): three buttons, 5 bits of padding, two relative axes of a byte.
TEST(HidReportDescriptor, ReadsTheMouseOfTheSpecification) {
  const std::vector<std::uint8_t> mouse = {
      0x05, 0x01, 0x09, 0x02, 0xA1, 0x01, 0x09, 0x01, 0xA1, 0x00, 0x05, 0x09, 0x19,
      0x01, 0x29, 0x03, 0x15, 0x00, 0x25, 0x01, 0x95, 0x03, 0x75, 0x01, 0x81, 0x02,
      0x95, 0x01, 0x75, 0x05, 0x81, 0x01, 0x05, 0x01, 0x09, 0x30, 0x09, 0x31, 0x15,
      0x81, 0x25, 0x7F, 0x75, 0x08, 0x95, 0x02, 0x81, 0x06, 0xC0, 0xC0};
  const auto layout = parse_report_descriptor(mouse);
  ASSERT_TRUE(layout.ok()) << layout.error().message();
  ASSERT_EQ(layout.value().fields.size(), 5u);
  EXPECT_FALSE(layout.value().numbered);
  EXPECT_EQ(layout.value().fields[2].usage, 0x00090003u);
  const HidField& y = layout.value().fields[4];
  EXPECT_EQ(y.usage, 0x00010031u);
  EXPECT_EQ(y.bit, 16u);
  EXPECT_EQ(y.min, -127);
  EXPECT_TRUE(y.relative);
  EXPECT_EQ(value_in(HidReport{0x05, 0x00, 0xFE}, y, false), -2);
  EXPECT_EQ(value_in(HidReport{0x05, 0x00}, y, false), std::nullopt);  // cut off
}

// A byte of 0..255 whose maximum is written in one byte, which as a signed number would be -1.
TEST(HidReportDescriptor, AMaximumOf0xFFOverAMinimumOf0Is255) {
  const auto layout = parse_report_descriptor(HidReport{0x05, 0x01, 0x09, 0x30, 0x15, 0x00, 0x25,
                                                        0xFF, 0x75, 0x08, 0x95, 0x01, 0x81, 0x02});
  ASSERT_TRUE(layout.ok());
  EXPECT_EQ(layout.value().fields.at(0).max, 255);
  EXPECT_EQ(value_in(HidReport{0xF0}, layout.value().fields[0], false), 0xF0);
}

TEST(HidReportDescriptor, EveryCutAndEveryFlippedByteIsReadOrRefusedInBounds) {
  const HidReport whole = PlayedStick().identity().descriptor;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    (void)parse_report_descriptor(std::span(whole).first(i));
    for (int byte = 0; byte < 256; ++byte) {
      HidReport other = whole;
      other[i] = static_cast<std::uint8_t>(byte);
      const auto layout = parse_report_descriptor(other);
      if (!layout) continue;
      for (const HidField& field : layout.value().fields)
        (void)value_in(HidReport(7, 0xFF), field, layout.value().numbered);
    }
  }
  EXPECT_FALSE(parse_report_descriptor(HidReport{0xB4}).ok());        // Pop without Push
  EXPECT_FALSE(parse_report_descriptor(HidReport{0x26, 0x01}).ok());  // cut short
  EXPECT_FALSE(parse_report_descriptor(HidReport{0x09, 0x30, 0x75, 0x21, 0x95, 0x01, 0x81, 0x02})
                   .ok());  // 33 bits
}

TEST(GameController, AxesAndButtonsComeFromWhereTheDescriptorSays) {
  Bench bench;
  GameController controller = bench.start({});
  ASSERT_EQ(controller.axes(), 3u);  // X, Y and the throttle: a hat is none
  bench.stick.move(1023, 0, 100, 0b1000'0000'0001);
  bench.stick.tell_battery(50);
  const StickState& state = controller.poll(10'000'000);
  EXPECT_TRUE(near(state.axes[0], 1.0, kExact));
  EXPECT_TRUE(near(state.axes[1], -1.0, kExact));
  EXPECT_TRUE(near(state.axes[2], 1.0, kExact));
  EXPECT_EQ(controller.counts_of_axis(2), 100);
  ASSERT_EQ(state.buttons.size(), 12u);
  EXPECT_TRUE(state.buttons[0] && state.buttons[11]);
  EXPECT_FALSE(state.buttons[1] || state.buttons[10]);
  bench.stick.move(512, 512, -50);
  controller.poll(10'000'000);
  EXPECT_TRUE(near(state.axes[2], -0.5, kExact));
  EXPECT_FALSE(state.buttons[0]);
}

TEST(GameController, NothingJumpsAtTheEdgeOfTheDeadZone) {
  const AxisCalibration axis{100, 500, 1000, 20};
  EXPECT_TRUE(near(axis.value_of(520), 0.0, kExact));
  EXPECT_TRUE(near(axis.value_of(480), 0.0, kExact));
  EXPECT_TRUE(near(axis.value_of(760), 0.5, kExact));   // half way from 520 to 1000
  EXPECT_TRUE(near(axis.value_of(290), -0.5, kExact));  // half way from 480 to 100
  EXPECT_TRUE(near(axis.value_of(1023), 1.0, kExact));
  EXPECT_TRUE(near(axis.value_of(0), -1.0, kExact));
}

TEST(GameController, AThrottleWithoutAMiddleGoesFrom0To1) {
  AxisCalibration axis{10, 10, 210};
  axis.has_middle = false;
  EXPECT_TRUE(near(axis.value_of(0), 0.0, kExact));
  EXPECT_TRUE(near(axis.value_of(60), 0.25, kExact));
  axis.reversed = true;
  EXPECT_TRUE(near(axis.value_of(60), 0.75, kExact));
}

TEST(GameController, UnplugAndSilenceAreALossThatStays) {
  Bench bench;
  GameController controller = bench.start({});
  bench.stick.move(1023, 512, 0);
  EXPECT_TRUE(controller.poll(10'000'000).present);
  bench.cable.plugged = false;
  EXPECT_FALSE(controller.poll(10'000'000).present);
  EXPECT_NE(controller.poll(0).why_lost.find("plug"), std::string::npos);
  bench.cable.plugged = true;
  bench.stick.move(0, 0, 0);
  EXPECT_FALSE(controller.poll(10'000'000).present);

  Bench quiet;
  GameController silent = quiet.start({}, 100'000'000);
  quiet.stick.move(512, 512, 0);
  EXPECT_TRUE(silent.poll(50'000'000).present);
  EXPECT_FALSE(silent.poll(200'000'000).present);
}

TEST(GameController, CalibrationsThatDoNotRiseOrAreTooManyAreRefused) {
  Bench bench;
  const auto refused = [&](std::vector<AxisCalibration> calibrations) {
    return !GameController::start(
                std::make_unique<MemoryHidPort>(bench.queue, bench.stick, bench.cable),
                std::move(calibrations))
                .ok();
  };
  EXPECT_TRUE(refused({{0, 5, 0}}));
  EXPECT_TRUE(refused({{0, 11, 10}}));
  EXPECT_TRUE(refused(std::vector<AxisCalibration>(4, {0, 5, 10})));
}

}  // namespace
}  // namespace whirl::io
