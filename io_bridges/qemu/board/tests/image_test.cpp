// Images that nobody's linker made.
#include "io_bridges/qemu/board/image.hpp"

#include <gtest/gtest.h>

#include "io_bridges/qemu/board/tests/elf_writer.hpp"

namespace whirl::board {
namespace {

Elf elf_with(const std::vector<std::string>& functions, std::uint16_t symbol_tables = 1) {
  Elf elf;
  elf.functions = functions;
  elf.symbol_tables = symbol_tables;
  return elf;
}

TEST(Image, NamesAreDemangled) {
  const auto image = load(elf_with({"_ZN2fw8imu_taskEv", "main"}));
  ASSERT_TRUE(image.ok()) << image.error().message();
  EXPECT_EQ(image.value().functions_named("fw::imu_task").size(), 1u);
  EXPECT_EQ(image.value().functions_named("main").size(), 1u);
}

// A<A<...>, A<...>>, each S_ twice the one before: 2^30 arguments when it is written out.
TEST(Image, ANameThatWouldFillTheMemoryStaysMangled) {
  const std::string digits = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ";
  std::string name = "_Z1f1AIiiE";
  for (int i = 0; i < 30; ++i) {
    const std::string last = std::string("S") + digits[static_cast<std::size_t>(i)] + "_";
    name += "S_I" + last + last + "E";
  }
  const auto image = load(elf_with({name}));
  ASSERT_TRUE(image.ok());
  EXPECT_EQ(image.value().symbols()[0].name, name);
}

TEST(Image, TablesThatLieOverEachOtherAreRefused) {
  EXPECT_TRUE(load(elf_with({"a", "b"}, 2)).ok());
  const auto image = load(elf_with(std::vector<std::string>(1000, "a"), 1000));
  ASSERT_FALSE(image.ok());
  EXPECT_NE(image.error().what.find("overlapping symbols"), std::string::npos);
}

TEST(Image, AnEndlessFileIsRefused) {
  const auto image = load_image("/dev/zero", *find_part("stm32f405rg"));
  ASSERT_FALSE(image.ok());
  EXPECT_NE(image.error().what.find("no plain file"), std::string::npos);
}

}  // namespace
}  // namespace whirl::board
