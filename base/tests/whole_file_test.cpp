#include "base/whole_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "base/scratch_folder.hpp"

namespace whirl {
namespace {

TEST(WholeFile, GivesEveryByte) {
  const ScratchFolder folder;
  const std::string bytes("a\0\r\nb", 5);
  std::ofstream(folder.file("all"), std::ios::binary) << bytes;
  const auto read = read_whole_file(folder.file("all"));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read.value(), bytes);
}

TEST(WholeFile, OnlyPlainFilesAreRead) {
  EXPECT_FALSE(read_whole_file("/dev/zero").ok());
  EXPECT_FALSE(read_whole_file("/tmp").ok());
  EXPECT_FALSE(read_whole_file(std::string(5000, 'x')).ok());
}

}  // namespace
}  // namespace whirl
