// What may stand at a key, and how people are shown it.
#include "io_bridges/rack/device_key.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

using Words = std::vector<std::string>;
using Numbers = std::vector<double>;

TEST(DeviceKey, ABusIsItsKindAndANumber) {
  const DeviceKey i2c = bus_key("i2c", ""), uart = bus_key("usart", "");
  for (const char* good : {"i2c1", "i2c12"}) EXPECT_EQ(complaint(i2c, good), "") << good;
  for (const char* bad : {"i2c", "i2c0", "i2c03", "i2c100", "spi1", "i2c1 ", "", "1", "i2c-1"}) {
    EXPECT_NE(complaint(i2c, bad).find("is no bus for it"), std::string::npos) << bad;
  }
  EXPECT_EQ(complaint(uart, "usart1"), "");
  EXPECT_EQ(complaint(uart, "uart4"), "");
  EXPECT_EQ(complaint(i2c, 3.0), "is no text");
}

TEST(DeviceKey, ABusMayBeOfTwoKinds) {
  const DeviceKey key = bus_key("i2c or spi", "");
  for (const char* good : {"i2c1", "spi2"}) EXPECT_EQ(complaint(key, good), "") << good;
  for (const char* bad : {"usart1", "i2c or spi1", "spi", "i2c0"}) {
    EXPECT_NE(complaint(key, bad), "") << bad;
  }
  EXPECT_EQ(unit_text(key), "bus i2cN or spiN");
  EXPECT_EQ(default_text(pin_key("cs", "").need().on("spi")), "needed on spi");
}

TEST(DeviceKey, APinIsAPortAndANumber) {
  const DeviceKey pin = pin_key("cs", "");
  for (const char* good : {"PA0", "PB15", "PK7"}) EXPECT_EQ(complaint(pin, good), "") << good;
  for (const char* bad : {"PB16", "PL1", "pa0", "B0", "PB", "PB01", "PB-1", ""}) {
    EXPECT_NE(complaint(pin, bad), "") << bad;
  }
}

TEST(DeviceKey, ANumberIsWithinItsLimitsAndNeverATextOrNaN) {
  const DeviceKey rate = quantity_key("rate", Dimension::frequency, "kHz", {1e3, 400e3}, "");
  EXPECT_EQ(complaint(rate, 1e3), "");
  EXPECT_EQ(complaint(rate, 400e3), "");
  EXPECT_EQ(complaint(rate, 401e3), "401 kHz is outside 1..400 kHz");
  EXPECT_NE(complaint(rate, 999.0), "");
  EXPECT_NE(complaint(rate, std::nan("")), "");
  EXPECT_EQ(complaint(rate, "fast"), "is no number");
  EXPECT_EQ(complaint(address_key(), 8.5), "8.5 is no whole number");
  EXPECT_NE(complaint(triple_key("p", Dimension::length, "m", {-5, 5}, ""), Numbers{1, 2}), "");
  EXPECT_NE(complaint(triple_key("p", Dimension::length, "m", {-5, 5}, ""), Numbers{1, 2, 6}), "");
  EXPECT_NE(complaint(flag_key("f", ""), 1.0), "");
}

TEST(DeviceKey, AxesAreARightHandedSignedPermutation) {
  const DeviceKey axes = axes_key("axes", "");
  int right_handed = 0;
  const char* kAll[] = {"+x", "-x", "+y", "-y", "+z", "-z"};
  for (const char* a : kAll) {
    for (const char* b : kAll) {
      for (const char* c : kAll) right_handed += complaint(axes, Words{a, b, c}).empty() ? 1 : 0;
    }
  }
  EXPECT_EQ(right_handed, 24);  // the rotations of a cube
  EXPECT_EQ(complaint(axes, Words{"+x", "-y", "-z"}), "");
  EXPECT_NE(complaint(axes, Words{"+x", "+y", "-z"}).find("left-handed"), std::string::npos);
  EXPECT_NE(complaint(axes, Words{"+x", "-x", "+z"}).find("x, y and z"), std::string::npos);
  for (const Words& bad :
       {Words{"x", "y", "z"}, Words{"+x", "+y"}, Words{"+x", "+y", "+w"}, Words{}}) {
    EXPECT_NE(complaint(axes, bad), "");
  }
}

// A unit that is not one of its dimension would show every figure as "nan".
TEST(DeviceKey, EachKeyOfTheTableIsShownInAUnitOfItsDimension) {
  for (const DeviceType& type : device_types()) {
    for (const DeviceKey& key : type.keys) {
      const std::string where = type.name + " " + key.path;
      EXPECT_EQ((range_text(key) + default_text(key) + unit_text(key)).find("nan"),
                std::string::npos)
          << where;
      EXPECT_FALSE(key.about.empty()) << where;
      if (key.dimension != Dimension::none) {
        EXPECT_TRUE(parse_quantity_as("1 " + key.unit, key.dimension, "")) << where;
      }
    }
  }
}

TEST(DeviceKey, EachDefaultOfTheTableMayStandInAFile) {
  for (const DeviceType& type : device_types()) {
    for (const DeviceKey& key : type.keys) {
      if (!key.fallback) continue;
      EXPECT_EQ(complaint(key, *key.fallback), "") << type.name << " " << key.path;
      EXPECT_FALSE(key.needed) << type.name << " " << key.path;
    }
  }
}

}  // namespace
}  // namespace whirl::rack
