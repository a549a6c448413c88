// Logs as a PC finds them: written by the firmware onto a simulated card, read by mtools, judged by
// fsck.fat.
#include <gtest/gtest.h>

#include "firmware/tests/log_rig.hpp"
#include "io_bridges/devices/fresh_volume.hpp"

namespace fw {
namespace {

using io::FaultKind;

void expect_clean(const std::string& image) {
  const ToolSaid checked = run_tool("fsck.fat -n " + image);
  EXPECT_EQ(checked.code, 0) << checked.words;
}
std::string copied(const TestFolder& folder, const std::string& image, const std::string& name) {
  std::filesystem::remove(folder.file("out"));
  const ToolSaid got = run_tool("mcopy -n -i " + image + " ::" + name + " " + folder.file("out"));
  EXPECT_EQ(got.code, 0) << got.words;
  return bytes_of(folder.file("out"));
}

TEST(LogVolume, WhatWasAppendedIsInAFileOfItsTrueSizeAfterClosing) {
  TestFolder folder;
  make_volume(folder, "base.img");
  LogRig rig(folder, "base.img", CardRig::quick());
  rig.log.set_time(0x5D76, 0x31F1);
  ASSERT_TRUE(rig.until(LogState::logging, 3000));
  rig.run_ms(1500);
  rig.log.close();
  ASSERT_TRUE(rig.until(LogState::closed, 3000));
  EXPECT_EQ(rig.log.dropped(), 0u);
  const std::string text = copied(folder, rig.image_path, "LOG00001.ULG");
  EXPECT_EQ(text.size(), rig.appended * kRecord_bytes);
  EXPECT_EQ(records_in(text), rig.appended);
  EXPECT_GT(rig.appended, 2900u);
  EXPECT_EQ(copied(folder, rig.image_path, "OTHER.TXT"), std::string(100'000, 'o'));
  const ToolSaid list = run_tool("mdir -i " + rig.image_path);
  EXPECT_NE(list.words.find("2026-11-22   6:15"), std::string::npos) << list.words;
  expect_clean(rig.image_path);
  EXPECT_TRUE(rig.rig.findings.empty()) << rig.rig.findings[0];
}

TEST(LogVolume, EachOpeningTakesTheNextNumberAndFreesWhatWasLeftOver) {
  TestFolder folder;
  make_volume(folder, "base.img");
  LogRig rig(folder, "base.img", CardRig::quick());
  for (std::uint32_t file = 1; file <= 3; ++file) {
    rig.appended = 0;
    ASSERT_TRUE(rig.until(LogState::logging, 3000));
    EXPECT_EQ(rig.log.number(), file);
    EXPECT_EQ(rig.log.files(), file);
    rig.run_ms(static_cast<int>(100 * file));
    rig.log.close();
    ASSERT_TRUE(rig.until(LogState::closed, 3000));
    const std::string name = "LOG0000" + std::to_string(file) + ".ULG";
    EXPECT_EQ(records_in(copied(folder, rig.image_path, name)), rig.appended);
    rig.log.open();
    expect_clean(rig.image_path);
  }
  // 64 MiB less the FATs, the other file and three short logs: three times 1 MiB has come back.
  const ToolSaid list = run_tool("mdir -i " + rig.image_path + " | tail -2 | tr -d ' '");
  EXPECT_NE(list.words.find("65"), std::string::npos) << list.words;
}

TEST(LogVolume, AnEmptyLogHasNoCluster) {
  TestFolder folder;
  make_volume(folder, "base.img");
  LogRig rig(folder, "base.img", CardRig::quick());
  rig.records_per_ms = 0;
  ASSERT_TRUE(rig.until(LogState::logging, 3000));
  rig.log.close();
  ASSERT_TRUE(rig.until(LogState::closed, 3000));
  EXPECT_EQ(copied(folder, rig.image_path, "LOG00001.ULG"), "");
  expect_clean(rig.image_path);
}

TEST(LogVolume, WhileItLogsTheFileHasItsFullSizeAndZerosBehindTheRecords) {
  TestFolder folder;
  make_volume(folder, "base.img");
  LogRig rig(folder, "base.img", CardRig::quick());
  ASSERT_TRUE(rig.until(LogState::logging, 3000));
  rig.run_ms(700);
  expect_clean(rig.image_path);
  const std::string text = copied(folder, rig.image_path, "LOG00001.ULG");
  EXPECT_EQ(text.size(), 1u << 20);
  EXPECT_GE(records_in(text) + 100, rig.appended);
  EXPECT_EQ(text.substr(60'000), std::string(text.size() - 60'000, '\0'));
}

// The card's bytes are the file's: what a PC deletes in between lies where the next log comes.
TEST(LogVolume, RecordsOfADeletedLogDoNotShowBehindNewOnes) {
  TestFolder folder;
  make_volume(folder, "base.img");
  LogRig rig(folder, "base.img", CardRig::quick());
  ASSERT_TRUE(rig.until(LogState::logging, 3000));
  rig.run_ms(1000);
  rig.log.close();
  ASSERT_TRUE(rig.until(LogState::closed, 3000));
  ASSERT_EQ(run_tool("mdel -i " + rig.image_path + " ::LOG00001.ULG").code, 0);
  rig.log.open();
  rig.appended = 0;
  ASSERT_TRUE(rig.until(LogState::logging, 3000));
  EXPECT_EQ(rig.log.number(), 1u);
  rig.run_ms(100);
  const std::string text = copied(folder, rig.image_path, "LOG00001.ULG");
  EXPECT_EQ(text.substr(10'000), std::string(text.size() - 10'000, '\0'));
  EXPECT_GT(records_in(text), 150u);
}

TEST(LogVolume, ASlowLogIsOnTheCardWithinASecond) {
  TestFolder folder;
  make_volume(folder, "base.img");
  LogRig rig(folder, "base.img", CardRig::quick());
  rig.records_per_ms = 0;
  ASSERT_TRUE(rig.until(LogState::logging, 3000));
  std::uint32_t a_second_ago[11] = {};
  for (std::uint32_t i = 0; i < 60; ++i) {  // a record each 100 ms: a block in 1.6 s
    ASSERT_TRUE(rig.log.append(record(rig.appended++)));
    rig.run_ms(100);
    std::copy(a_second_ago + 1, a_second_ago + 11, a_second_ago);
    a_second_ago[10] = rig.appended;
    EXPECT_GE(records_in(copied(folder, rig.image_path, "LOG00001.ULG")), a_second_ago[0]) << i;
  }
  rig.log.close();
  ASSERT_TRUE(rig.until(LogState::closed, 3000));
  EXPECT_EQ(copied(folder, rig.image_path, "LOG00001.ULG").size(), 60 * kRecord_bytes);
}

TEST(LogVolume, AFullFileIsFollowedByTheNext) {
  TestFolder folder;
  make_volume(folder, "base.img");
  LogRig rig(folder, "base.img", CardRig::quick(), {1u << 18, 1u << 18});
  ASSERT_TRUE(rig.until(LogState::logging, 3000));
  for (int i = 0; i < 20'000 && rig.log.files() < 2; ++i) rig.step_ms();
  ASSERT_EQ(rig.log.files(), 2u);
  EXPECT_EQ(records_in(copied(folder, rig.image_path, "LOG00001.ULG")), (1u << 18) / kRecord_bytes);
  expect_clean(rig.image_path);
}

TEST(LogVolume, TakesTheLongestRunWhereThereIsLessRoom) {
  TestFolder folder;
  make_volume(folder, "base.img");
  LogRig rig(folder, "base.img", CardRig::quick(), {128u << 20, 1u << 20});
  ASSERT_TRUE(rig.until(LogState::logging, 60'000));
  const std::string text = copied(folder, rig.image_path, "LOG00001.ULG");
  const ToolSaid list = run_tool("mdir -i " + rig.image_path + " | tail -2 | tr -dc '0-9'");
  EXPECT_EQ(list.words, "0");  // bytes free: it has all
  EXPECT_GT(text.size(), 61u << 20);
}

TEST(LogVolume, WorksInThePartitionOfAFreshCard) {
  TestFolder folder;
  {
    auto memory = io::MemoryFile::create(folder.file("fresh.img"), 64 << 20);
    ASSERT_TRUE(memory);
    io::write_fresh_volume(memory.value(), 1);
  }
  LogRig rig(folder, "fresh.img", CardRig::quick());
  ASSERT_TRUE(rig.until(LogState::logging, 3000));
  rig.run_ms(100);
  rig.log.close();
  ASSERT_TRUE(rig.until(LogState::closed, 3000));
  EXPECT_EQ(records_in(copied(folder, rig.image_path + "@@1M", "LOG00001.ULG")), rig.appended);
}

TEST(LogVolume, WithoutAVolumeItRefuses) {
  TestFolder folder;
  std::ofstream(folder.file("none.img")) << "nothing";
  LogRig rig(folder, "none.img", CardRig::quick());
  EXPECT_TRUE(rig.until(LogState::refused, 3000));
  const std::string fat16 = folder.file("fat16.img");
  ASSERT_EQ(run_tool("mkfs.fat -F 16 -C " + fat16 + " 65536").code, 0);
  LogRig other(folder, "fat16.img", CardRig::quick());
  EXPECT_TRUE(other.until(LogState::refused, 3000));
  EXPECT_EQ(other.rig.commands[25], 0);  // and writes nothing
}

TEST(LogVolume, ACardPutInAgainGetsANewFile) {
  TestFolder folder;
  make_volume(folder, "base.img");
  LogRig rig(folder, "base.img", CardRig::quick());
  ASSERT_TRUE(rig.until(LogState::logging, 3000));
  rig.run_ms(300);
  rig.rig.add(FaultKind::memory_removed, rig.rig.now_ms(), rig.rig.now_ms() + 400.0);
  rig.run_ms(50);
  EXPECT_EQ(rig.log.state(), LogState::no_card);
  rig.appended = 0;
  ASSERT_TRUE(rig.until(LogState::logging, 5000));
  EXPECT_EQ(rig.log.number(), 2u);
  EXPECT_EQ(rig.log.failures(), 1u);
  EXPECT_GT(rig.log.dropped(), 0u);
  rig.run_ms(100);
  rig.log.close();
  ASSERT_TRUE(rig.until(LogState::closed, 3000));
  EXPECT_EQ(records_in(copied(folder, rig.image_path, "LOG00002.ULG")), rig.appended);
  expect_clean(rig.image_path);
}

TEST(LogVolume, StallsOfAQuarterSecondLoseNothing) {
  TestFolder folder;
  make_volume(folder, "base.img");
  io::SdCard::Params params = CardRig::quick();
  params.stall_every = 40.0;  // each third of a second
  LogRig rig(folder, "base.img", params);
  rig.records_per_ms = 1;
  ASSERT_TRUE(rig.until(LogState::logging, 10'000));
  rig.run_ms(4000);
  rig.log.close();
  ASSERT_TRUE(rig.until(LogState::closed, 10'000));
  EXPECT_EQ(rig.log.dropped(), 0u);
  EXPECT_EQ(records_in(copied(folder, rig.image_path, "LOG00001.ULG")), rig.appended);
}

}  // namespace
}  // namespace fw
