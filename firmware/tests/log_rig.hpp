// A log volume on a card that mkfs.fat has formatted, and what a PC's tools say of it afterwards.
#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "firmware/log/log_volume.hpp"
#include "firmware/tests/card_rig.hpp"

namespace fw {

struct ToolSaid {
  int code = -1;
  std::string words;
};
inline ToolSaid run_tool(const std::string& command) {
  ToolSaid said;
  FILE* pipe = popen(("PATH=$PATH:/sbin:/usr/sbin; " + command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return said;
  char line[512];
  while (std::fgets(line, sizeof line, pipe) != nullptr) said.words += line;
  said.code = WEXITSTATUS(pclose(pipe));
  return said;
}

struct TestFolder {
  TestFolder() { std::filesystem::create_directories(path); }
  ~TestFolder() { std::filesystem::remove_all(path); }
  std::string file(const std::string& name) const { return path + "/" + name; }
  std::string path = testing::TempDir() + "log_volume." + std::to_string(getpid());
};

inline std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// A FAT32 volume of 64 MiB without partitions, with a file of somebody else's on it.
inline void make_volume(const TestFolder& folder, const std::string& name) {
  std::ofstream(folder.file("other.txt")) << std::string(100'000, 'o');
  const std::string image = folder.file(name);
  const ToolSaid made = run_tool("mkfs.fat -F 32 -i 12345678 -C " + image + " 65536");
  ASSERT_EQ(made.code, 0) << made.words;
  const ToolSaid put =
      run_tool("mcopy -i " + image + " " + folder.file("other.txt") + " ::OTHER.TXT");
  ASSERT_EQ(put.code, 0) << put.words;
}

// A record says which one it is in all its bytes' neighbourhood: 32 bytes, number and a check.
inline constexpr std::size_t kRecord_bytes = 32;
inline std::array<std::uint8_t, kRecord_bytes> record(std::uint32_t number) {
  std::array<std::uint8_t, kRecord_bytes> bytes{};
  for (std::size_t i = 0; i < kRecord_bytes; ++i) {
    bytes[i] = static_cast<std::uint8_t>((number >> (8 * (i % 4))) ^ (i / 4 * 0x5B + 0xA5));
  }
  return bytes;
}
// How many whole records a file begins with, one after the other from 0 on.
inline std::uint32_t records_in(const std::string& text) {
  std::uint32_t number = 0;
  for (std::size_t at = 0; at + kRecord_bytes <= text.size(); at += kRecord_bytes, ++number) {
    const auto want = record(number);
    for (std::size_t i = 0; i < kRecord_bytes; ++i) {
      if (static_cast<std::uint8_t>(text[at + i]) != want[i]) return number;
    }
  }
  return number;
}

struct LogRig {
  using Volume = LogVolume<SdCard<CardRig::Bus>>;

  // Works on a copy of the image, which is then image_path.
  LogRig(const TestFolder& folder, const std::string& image, const io::SdCard::Params& params,
         Volume::Sizes sizes = {1u << 20, 1u << 18})
      : image_path(folder.file("card.img")),
        rig(params, contents(folder.file(image), image_path)),
        log(rig.card, ring, sizes) {}

  static io::MemoryFile contents(const std::string& image, const std::string& path) {
    auto file = io::MemoryFile::create(path, 64 << 20);
    EXPECT_TRUE(file && file.value().copy_from(image));
    return std::move(file.value());
  }

  void quarter_ms() {
    rig.queue.run_until(std::max(rig.queue.now(), next_ns));
    next_ns += 250'000;
    log.tick(rig.now_us());
    rig.card.tick(rig.now_us());
  }
  // A millisecond: two records each, 64 KB a second, as soon as there is a file.
  void step_ms() {
    for (int i = 0; i < 4; ++i) quarter_ms();
    if (log.state() != LogState::logging) return;
    for (int i = 0; i < records_per_ms; ++i) {
      if (log.append(record(appended))) ++appended;
    }
  }
  bool until(LogState state, int limit_ms) {
    for (int i = 0; i < limit_ms && log.state() != state; ++i) step_ms();
    return log.state() == state;
  }
  void run_ms(int count) {
    for (int i = 0; i < count; ++i) step_ms();
  }

  std::string image_path;
  CardRig rig;
  std::array<std::uint8_t, 16384> ring{};
  Volume log;
  io::Nanoseconds next_ns = 0;
  int records_per_ms = 2;
  std::uint32_t appended = 0;
};

}  // namespace fw
