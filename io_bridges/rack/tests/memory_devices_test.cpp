// Card and EEPROM as a board carries them: what they start as, and the file that they leave.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "io_bridges/devices/memory_file.hpp"
#include "io_bridges/rack/tests/bench_rack.hpp"

namespace whirl::rack {
namespace {

using Bytes = BenchRack::Bytes;

struct Folder {
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string file(const std::string& name) const { return path + "/" + name; }
  std::string path = testing::TempDir() + "memory_devices." + std::to_string(getpid());
};

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

BoardDevice eeprom() {
  return {.name = "params", .type = "eeprom_24xx", .bus = "i2c1", .address = 0x50};
}
BoardDevice card() {
  BoardDevice device{.name = "card", .type = "sd_card", .bus = "spi1"};
  device.set("cs", "PA4");
  device.set("size", 64.0 * 1024 * 1024);
  return device;
}

TEST(EepromDevice, StartsBlankAndItsFileHoldsWhatWasWritten) {
  Folder folder;
  BenchRack rack;
  rack.folder = folder.path;
  ASSERT_NE(rack.add(eeprom()), nullptr) << rack.error;
  EXPECT_EQ(rack.i2c_transfer(0x50, {0, 0}, 2), (Bytes{0xFF, 0xFF}));
  rack.i2c_transfer(0x50, {0x01, 0x20, 0x12, 0x34}, 0);
  rack.run_ms(6.0);
  const std::string held = text_of(folder.file("params.img"));  // while it is in use
  ASSERT_EQ(held.size(), 16384u);
  EXPECT_EQ(held.substr(0x11F, 4), "\xFF\x12\x34\xFF");
}

TEST(EepromDevice, StartsAsItsImageWhichStaysAsItIs) {
  Folder folder;
  std::ofstream(folder.file("given.bin")) << "abcd";
  BenchRack rack;
  rack.folder = folder.path;
  BoardDevice device = eeprom();
  device.set("image", folder.file("given.bin"));
  ASSERT_NE(rack.add(device), nullptr) << rack.error;
  EXPECT_EQ(rack.i2c_transfer(0x50, {0, 2}, 3), (Bytes{'c', 'd', 0xFF}));
  rack.i2c_transfer(0x50, {0, 0, 'x'}, 0);
  rack.run_ms(6.0);
  EXPECT_EQ(text_of(folder.file("given.bin")), "abcd");
  EXPECT_EQ(text_of(folder.file("params.img")).substr(0, 2), "xb");
}

TEST(EepromDevice, ProtectedByItsPin) {
  BenchRack rack;
  BoardDevice device = eeprom();
  device.set("wp", "PC9");  // pulled up here
  ASSERT_NE(rack.add(device), nullptr) << rack.error;
  rack.i2c_transfer(0x50, {0, 0, 0x11}, 0);
  rack.run_ms(6.0);
  EXPECT_EQ(rack.i2c_transfer(0x50, {0, 0}, 1), Bytes{0xFF});
}

TEST(EepromDevice, SizesThatNoPartHasAreRefused) {
  BenchRack rack;
  BoardDevice device = eeprom();
  device.set("size", 10000.0);
  EXPECT_EQ(rack.add(device), nullptr);
  EXPECT_NE(rack.error.find("powers of two"), std::string::npos);
}

TEST(SdCardDevice, LeavesAFreshVolumeThatDependsOnTheSeedOnly) {
  Folder folder;
  std::string first;
  for (int run = 0; run < 2; ++run) {
    BenchRack rack;
    rack.folder = folder.path;
    ASSERT_NE(rack.add(card()), nullptr) << rack.error;
    const std::string held = text_of(folder.file("card.img"));
    ASSERT_EQ(held.size(), 64u * 1024 * 1024);
    EXPECT_EQ(held.substr((1 << 20) + 71, 19), "NO NAME    FAT32   ");
    if (run == 1) {
      EXPECT_TRUE(held == first);
    }
    first = held;
  }
  BenchRack rack(2);
  rack.folder = folder.path;
  ASSERT_NE(rack.add(card()), nullptr);
  EXPECT_FALSE(text_of(folder.file("card.img")) == first);
}

TEST(SdCardDevice, TakesTheSizeOfItsImageAndAnswersOnItsChipSelect) {
  Folder folder;
  {
    auto image = io::MemoryFile::create(folder.file("given.img"), 3 * 512 * 1024 - 100);
    ASSERT_TRUE(image);
    image.value().write(0, Bytes{1, 2, 3});
  }
  BenchRack rack;
  rack.folder = folder.path;
  BoardDevice device{.name = "card", .type = "sd_card", .bus = "spi1"};
  device.set("cs", "PA4");
  device.set("image", folder.file("given.img"));
  ASSERT_NE(rack.add(device), nullptr) << rack.error;
  EXPECT_EQ(io::file_size_bytes(folder.file("card.img")).value(), 3 * 512 * 1024);
  EXPECT_EQ(text_of(folder.file("card.img")).substr(0, 4), std::string("\x01\x02\x03\0", 4));
  rack.run_ms(2.0);
  for (int i = 0; i < 10; ++i) rack.spi_bus.transfer(0xFF, 400'000, 0, rack.queue.now());
  Bytes cmd0{0x40, 0, 0, 0, 0, 0x95};
  cmd0.resize(6 + 9, 0xFF);
  const Bytes got = rack.spi_transfer("PA4", cmd0);
  EXPECT_EQ(std::count(got.begin(), got.end(), 0x01), 1);
}

TEST(SdCardDevice, WhatNoCardCanBeIsRefused) {
  const auto complaint = [](const std::string& path, KeyValue value) {
    BenchRack rack;
    BoardDevice device = card();
    device.set(path, std::move(value));
    EXPECT_EQ(rack.add(device), nullptr);
    return rack.error;
  };
  EXPECT_NE(complaint("image", std::string("/nowhere/card.img")).find("cannot be read"),
            std::string::npos);
  EXPECT_NE(complaint("size", 64.0 * 1024 * 1024 + 512).find("units"), std::string::npos);
  EXPECT_NE(complaint("size", 1e6).find("size"), std::string::npos);
  BenchRack rack;
  BoardDevice device = card();
  device.set("params.high_capacity", false);
  device.set("size", 2048.0 * 1024 * 1024);
  EXPECT_EQ(rack.add(device), nullptr);
  EXPECT_NE(rack.error.find("at most 1024 MiB"), std::string::npos);
}

}  // namespace
}  // namespace whirl::rack
