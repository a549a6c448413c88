// ELF files written byte by byte: what is taken, what is refused, and why.
#include "io_bridges/qemu/board/image.hpp"

#include <gtest/gtest.h>

#include "io_bridges/qemu/board/tests/elf_writer.hpp"

namespace whirl::board {
namespace {

std::string refusal(const Elf& elf, const char* mcu = "stm32f405rg") {
  const auto image = load(elf, mcu);
  return image ? "" : image.error().message();
}
// Build attributes with one CPU architecture, as the ABI's addenda lay them out.
std::string built_for(char arch) {
  const std::string tags = {6, arch, 7, 'M'};
  const auto length = [](std::size_t n) { return std::string{static_cast<char>(n), 0, 0, 0}; };
  const std::string file = std::string(1, 1) + length(tags.size() + 5) + tags;
  const std::string vendor = std::string("aeabi") + '\0' + file;
  return "A" + length(vendor.size() + 4) + vendor;
}

TEST(ImageFile, AnEvenEntryPointIsNoFault) {
  Elf elf;
  elf.entry = 0x08000100;
  EXPECT_EQ(refusal(elf), "");
}

TEST(ImageFile, WhatLiesInRamIsLeftOutAsByAFlasher) {
  Elf elf;
  elf.loads.push_back({0x20000000, {1, 2, 3}});
  elf.loads.push_back({0x10000000, {4}});
  const auto image = load(elf);
  ASSERT_TRUE(image) << image.error().message();
  EXPECT_EQ(image.value().segments().size(), 1u);
}

TEST(ImageFile, OverlappingSegmentsAreRefused) {
  Elf elf;
  elf.loads.push_back({0x08000004, {7}});
  EXPECT_NE(refusal(elf).find("overlap at 0x08000004"), std::string::npos) << refusal(elf);
  elf.loads.back().address = 0x08000008;
  EXPECT_EQ(refusal(elf), "");
}

TEST(ImageFile, AFileThatIsCutBehindItsSegmentsIsRefused) {
  Elf elf;
  elf.cut_off = 4;
  EXPECT_NE(refusal(elf).find("cut off behind its segments"), std::string::npos);
}

TEST(ImageFile, AnotherCoreIsRefusedOrSaid) {
  Elf elf;
  elf.attributes = built_for(13);  // ARMv7E-M
  EXPECT_EQ(refusal(elf), "");
  EXPECT_NE(refusal(elf, "stm32f103cb").find("stm32f103cb is a Cortex-M3"), std::string::npos);
  elf.attributes = built_for(10);  // ARMv7-M
  EXPECT_EQ(load(elf, "stm32f103cb").value().oddities().size(), 0u);
  ASSERT_EQ(load(elf).value().oddities().size(), 1u);
  EXPECT_NE(load(elf).value().oddities()[0].find("built for a Cortex-M3"), std::string::npos);
}

TEST(ImageFile, ASecondFileLiesBesideTheFirst) {
  Elf image, boot;
  image.loads[0].address = 0x08004000;
  auto both = load(image);
  ASSERT_TRUE(both);
  EXPECT_FALSE(check_start(both.value(), "x.elf", 0x08000000));
  EXPECT_TRUE(check_start(both.value(), "x.elf", 0x08004000));
  ASSERT_TRUE(both.value().add(load(boot).value(), "boot.elf"));
  EXPECT_TRUE(check_start(both.value(), "x.elf", 0x08000000));
  EXPECT_FALSE(both.value().add(load(boot).value(), "boot.elf"));  // in its own way now
}

TEST(ImageFile, AnEvenResetVectorIsNoCode) {
  Elf elf;
  elf.loads[0].words[1] = 0x08000100;
  const auto start = check_start(load(elf).value(), "x.elf", 0x08000000);
  ASSERT_FALSE(start);
  EXPECT_NE(start.error().what.find("not Thumb code"), std::string::npos);
}

}  // namespace
}  // namespace whirl::board
