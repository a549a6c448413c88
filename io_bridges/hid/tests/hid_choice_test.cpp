#include <gtest/gtest.h>

#include <vector>

#include "io_bridges/hid/hid_device.hpp"

namespace whirl::io {
namespace {

const HidQuery kAny{"CP2112", 0x10C4, 0xEA90, ""};
const std::vector<HidEntry> kHere = {{"/dev/hidraw0", 0x10C4, 0xEA90, "left", "CP2112"},
                                     {"/dev/hidraw1", 0x10C4, 0xEA90, "right", "CP2112"},
                                     {"/dev/hidraw2", 0x04D8, 0x00DD, "third", "MCP2221"}};

HidQuery of_serial(const char* serial) {
  HidQuery query = kAny;
  query.serial = serial;
  return query;
}
bool says(const Error& error, const std::string& words) {
  return error.kind == ErrorKind::bad_input && error.message().find(words) != std::string::npos;
}

TEST(HidChoice, SerialNumberPicksOneOfSeveral) {
  const auto chosen = choose(kHere, of_serial("right"));
  ASSERT_TRUE(chosen.ok());
  EXPECT_EQ(chosen.value().path, "/dev/hidraw1");
}

TEST(HidChoice, WithoutSerialNumberThereMustBeOne) {
  EXPECT_TRUE(says(choose(kHere, kAny).error(), "name one by its serial number: left, right"));
  EXPECT_TRUE(choose(std::span(kHere).last(2), kAny).ok());
}

TEST(HidChoice, NothingThereAnotherKindAndAnotherSerialNumberAreToldApart) {
  EXPECT_TRUE(says(choose({}, kAny).error(), "no CP2112 (10c4:ea90) on this machine"));
  EXPECT_TRUE(
      says(choose(kHere, of_serial("third")).error(), "is a 'MCP2221' (04d8:00dd), no CP2112"));
  EXPECT_TRUE(says(choose(kHere, of_serial("other")).error(), "there are: left, right"));
}

TEST(HidChoice, UdevRuleNamesTheDeviceAsTheKernelDoes) {
  EXPECT_EQ(
      udev_rule(0x04D8, 0x00DD),
      R"(KERNEL=="hidraw*", KERNELS=="*:04D8:00DD.*", MODE="0660", GROUP="plugdev", TAG+="uaccess")");
}

}  // namespace
}  // namespace whirl::io
