#include "base/output_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "base/scratch_folder.hpp"
#include "base/whole_file.hpp"

namespace whirl {
namespace {

namespace fs = std::filesystem;

TEST(OutputFile, IsThereOnceItIsClosedAndNothingElse) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_text(folder.file("a"), "old"));
  {
    OutputFile lost(folder.file("a"));
    lost.write("new");
  }
  EXPECT_EQ(read_whole_file(folder.file("a")).value(), "old");
  EXPECT_FALSE(fs::exists(folder.file("a.part")));
  ASSERT_TRUE(write_text(folder.file("a"), "new"));
  EXPECT_EQ(read_whole_file(folder.file("a")).value(), "new");
}

// As root, --page /dev/full made a file of the device.
TEST(OutputFile, TakesNoDevicesPlace) {
  const ScratchFolder folder;
  const std::string pipe = folder.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  EXPECT_TRUE(write_text(pipe, "page"));
  char got[8] = {};
  EXPECT_EQ(::read(reader, got, sizeof got), 4);
  ::close(reader);
  EXPECT_STREQ(got, "page");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(OutputFile, OfALinkWritesWhatItLeadsTo) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_text(folder.file("there"), "old"));
  fs::create_symlink(folder.file("there"), folder.file("link"));
  ASSERT_TRUE(write_text(folder.file("link"), "new"));
  EXPECT_TRUE(fs::is_symlink(folder.file("link")));
  EXPECT_EQ(read_whole_file(folder.file("there")).value(), "new");
}

}  // namespace
}  // namespace whirl
