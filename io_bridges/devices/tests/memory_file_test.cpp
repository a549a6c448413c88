#include "io_bridges/devices/memory_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>
#include <system_error>

namespace whirl::io {
namespace {

using Bytes = std::array<std::uint8_t, 4>;
constexpr std::int64_t kGiB = 1LL << 30;

std::string temporary(const std::string& name) {
  return testing::TempDir() + "memory_file." + std::to_string(getpid()) + "." + name;
}
std::int64_t bytes_on_disk(const std::string& path) {
  struct stat status {};
  EXPECT_EQ(stat(path.c_str(), &status), 0);
  return status.st_blocks * 512LL;
}

TEST(MemoryFile, HoldsWhatWasWrittenAndTakesNoRoomForTheRest) {
  const std::string path = temporary("sparse");
  {
    auto file = MemoryFile::create(path, 2 * kGiB);
    ASSERT_TRUE(file);
    file.value().write(kGiB + 5, Bytes{1, 2, 3, 4});
    Bytes got{};
    file.value().read(kGiB + 6, got);
    EXPECT_EQ(got, (Bytes{2, 3, 4, 0}));
    EXPECT_EQ(file_size_bytes(path).value(), 2 * kGiB);  // it is there while it is in use
    EXPECT_LE(bytes_on_disk(path), 65536);
  }
  auto again = MemoryFile::create("", 2 * kGiB);
  ASSERT_TRUE(again && again.value().copy_from(path));
  Bytes got{};
  again.value().read(kGiB + 5, got);
  EXPECT_EQ(got, (Bytes{1, 2, 3, 4}));
  unlink(path.c_str());
}

TEST(MemoryFile, ClearedBytesAreZeroAndTheirNeighboursStay) {
  auto file = MemoryFile::create("", 1 << 20);
  ASSERT_TRUE(file);
  const std::array<std::uint8_t, 16384> ones = [] {
    std::array<std::uint8_t, 16384> bytes{};
    bytes.fill(0x11);
    return bytes;
  }();
  file.value().write(0, ones);
  file.value().clear(512, 8192);
  std::array<std::uint8_t, 16384> got{};
  file.value().read(0, got);
  for (std::size_t i = 0; i < got.size(); ++i) {
    ASSERT_EQ(got[i], i < 512 || i >= 512 + 8192 ? 0x11 : 0) << i;
  }
}

TEST(MemoryFile, AFileThatIsNotThereOrTooLargeIsRefused) {
  auto file = MemoryFile::create("", 1024);
  ASSERT_TRUE(file);
  const auto missing = file.value().copy_from(temporary("nowhere"));
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().kind, ErrorKind::bad_input);
  const std::string path = temporary("large");
  ASSERT_TRUE(MemoryFile::create(path, 1025));
  EXPECT_FALSE(file.value().copy_from(path));
  unlink(path.c_str());
  const auto no_folder = MemoryFile::create(temporary("no/folder"), 1024);
  ASSERT_FALSE(no_folder);
  EXPECT_EQ(no_folder.error().kind, ErrorKind::host);
}

// A full disk is the host's lack, and no bug of ours.
TEST(MemoryFile, WhatTheHostHasNoRoomForIsSaidToBeItsLack) {
  const std::string path = temporary("full");
  auto file = MemoryFile::create(path, 1 << 20);
  ASSERT_TRUE(file);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit little{4096, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &little), 0);
  file.value().write(0, Bytes{1, 2, 3, 4});
  EXPECT_THROW(file.value().write(8192, Bytes{1, 2, 3, 4}), std::system_error);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  unlink(path.c_str());
}

}  // namespace
}  // namespace whirl::io
