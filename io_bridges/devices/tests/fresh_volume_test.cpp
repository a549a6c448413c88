// What mkfs.fat's companions say of a volume of ours.
#include "io_bridges/devices/fresh_volume.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace whirl::io {
namespace {

constexpr std::int64_t kMiB = 1LL << 20;

std::string temporary(const std::string& name) {
  return testing::TempDir() + "fresh_volume." + std::to_string(getpid()) + "." + name;
}
struct Said {
  int code;
  std::string words;
};
Said run(const std::string& command) {
  Said said{-1, ""};
  FILE* pipe = popen(("PATH=$PATH:/sbin:/usr/sbin; " + command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return said;
  char line[256];
  while (std::fgets(line, sizeof line, pipe) != nullptr) said.words += line;
  said.code = WEXITSTATUS(pclose(pipe));
  return said;
}

// fsck.fat reads no partition table: the partition as a file of its own, with its holes.
void copy_partition(const std::string& image, const std::string& volume, std::int64_t size) {
  const int from = open(image.c_str(), O_RDONLY), to = creat(volume.c_str(), 0600);
  ASSERT_TRUE(from >= 0 && to >= 0 && ftruncate(to, size) == 0);
  std::vector<char> bytes(kMiB);
  for (off_t at = lseek(from, kMiB, SEEK_DATA); at >= 0; at = lseek(from, at, SEEK_DATA)) {
    const ssize_t got = pread(from, bytes.data(), bytes.size(), at);
    ASSERT_GT(got, 0);
    ASSERT_EQ(pwrite(to, bytes.data(), static_cast<std::size_t>(got), at - kMiB), got);
    at += got;
  }
  close(from);
  close(to);
}

class FreshVolume : public testing::TestWithParam<std::int64_t> {};

TEST_P(FreshVolume, IsCleanForFsckAndTakesAFileOfMtools) {
  const std::string image = temporary("img"), volume = temporary("part"), text = temporary("txt");
  {
    auto memory = MemoryFile::create(image, GetParam() * kMiB);
    ASSERT_TRUE(memory);
    write_fresh_volume(memory.value(), 0x12345678);
  }
  std::ofstream(text) << "hello\n";
  const Said put = run("mcopy -i " + image + "@@1M " + text + " ::HELLO.TXT");
  EXPECT_EQ(put.code, 0) << put.words;
  const Said list = run("mdir -i " + image + "@@1M ::");
  EXPECT_NE(list.words.find("HELLO    TXT         6"), std::string::npos) << list.words;
  EXPECT_NE(list.words.find("1234-5678"), std::string::npos) << list.words;
  copy_partition(image, volume, (GetParam() - 1) * kMiB);
  const Said checked = run("fsck.fat -n -V " + volume);
  EXPECT_EQ(checked.code, 0) << checked.words;
  EXPECT_EQ(checked.words.find("Warning"), std::string::npos) << checked.words;
  for (const std::string& file : {image, volume, text}) unlink(file.c_str());
}
TEST_P(FreshVolume, FilledItHasThatMuchRoomAndIsClean) {
  if (GetParam() * kMiB > kMost_filled_bytes) GTEST_SKIP() << "FAT has no file of that size";
  const std::string image = temporary("img"), volume = temporary("part");
  {
    auto memory = MemoryFile::create(image, GetParam() * kMiB);
    ASSERT_TRUE(memory);
    write_fresh_volume(memory.value(), 0x12345678);
    fill_fresh_volume(memory.value(), 3 * kMiB);
  }
  const Said list = run("mdir -i " + image + "@@1M ::");
  EXPECT_NE(list.words.find("3 145 728 bytes free"), std::string::npos) << list.words;
  EXPECT_NE(list.words.find("FULL     BIN"), std::string::npos) << list.words;
  copy_partition(image, volume, (GetParam() - 1) * kMiB);
  const Said checked = run("fsck.fat -n -V " + volume);
  EXPECT_EQ(checked.code, 0) << checked.words;
  for (const std::string& file : {image, volume}) unlink(file.c_str());
}

INSTANTIATE_TEST_SUITE_P(SizesInMiB, FreshVolume, testing::Values(64, 128, 260, 512, 2048, 16384));

}  // namespace
}  // namespace whirl::io
