// Logs out of volumes that mkfs.fat and mtools have made.
#include "results/flight_log/card_files.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "base/scratch_folder.hpp"

namespace whirl::results {
namespace {

struct Card : ScratchFolder {
  Card() { run("mkfs.fat -F 32 -C " + image + " 65536"); }
  static void run(const std::string& command) {
    const std::string quiet = "PATH=$PATH:/sbin:/usr/sbin; " + command + " >/dev/null";
    ASSERT_EQ(std::system(quiet.c_str()), 0) << command;  // NOLINT(cert-env33-c): tools of a PC
  }
  void put(const std::string& name, const std::string& text) {
    std::ofstream(file("text")) << text;
    run("mcopy -i " + image + " " + file("text") + " ::" + name);
  }
  // A byte of the image, in place of what stands there.
  void spoil(std::streamoff at, char byte) {
    std::fstream out(image, std::ios::in | std::ios::out | std::ios::binary);
    out.seekp(at).put(byte);
  }
  std::string image = file("card.img");
};

std::string text_of(const CardFile& file) {
  return {file.bytes.begin(), file.bytes.end()};
}

TEST(CardFiles, AreTheLogsInTheOrderOfTheirNumbersWithTheirBytes) {
  Card card;
  std::string text;
  for (int i = 0; i < 40'000; ++i) text += std::to_string(i) + ",";
  card.put("LOG00002.ULG", "second");
  card.put("OTHER.TXT", "not a log");
  card.put("LOG00001.ULG", text);
  Card::run("mdel -i " + card.image + " ::OTHER.TXT");
  card.put("LOG00003.ULG", text + "3");  // begins in the gap, in two pieces
  const auto files = logs_on_card(card.image);
  ASSERT_TRUE(files) << files.error().message();
  ASSERT_EQ(files.value().size(), 3u);
  EXPECT_EQ(files.value()[0].name, "LOG00001.ULG");
  EXPECT_EQ(text_of(files.value()[0]), text);
  EXPECT_EQ(text_of(files.value()[1]), "second");
  EXPECT_EQ(text_of(files.value()[2]), text + "3");
}

TEST(CardFiles, AChainInACircleEndsWithTheFilesSize) {
  Card card;
  card.put("LOG00001.ULG", std::string(2000, 'x'));
  const auto before = logs_on_card(card.image);
  ASSERT_TRUE(before);
  // Clusters of one sector; the file has 3 to 6. Cluster 4 leads back to 3, in the first FAT.
  card.spoil(32 * 512 + 4 * 4, 3);
  const auto after = logs_on_card(card.image);
  ASSERT_TRUE(after) << after.error().message();
  EXPECT_EQ(after.value()[0].bytes.size(), 2000u);
}

TEST(CardFiles, ARootDirectoryInACircleIsRefused) {
  Card card;
  card.put("LOG00001.ULG", "x");
  card.spoil(32 * 512 + 4 * 2, 2);
  for (const int byte : {1, 2, 3}) card.spoil(32 * 512 + 4 * 2 + byte, 0);
  EXPECT_FALSE(logs_on_card(card.image));
}

TEST(CardFiles, WhatIsNoVolumeIsSaid) {
  ScratchFolder folder;
  std::ofstream(folder.file("a.img")) << std::string(10'000, 'x');
  EXPECT_FALSE(logs_on_card(folder.file("a.img")));
  EXPECT_FALSE(logs_on_card(folder.file("none.img")));
}

}  // namespace
}  // namespace whirl::results
