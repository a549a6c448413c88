#include "harness/catalogue/bench_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "base/scratch_folder.hpp"

namespace whirl {
namespace {

const std::string kGood = R"(return {
  bench = "b", board = "esc32v2", pace = 0.5, late = "300 us", late_share = "2 %",
  links = {
    { name = "throttle", bus = "i2c2", bridge = "cp2112", serial = "X1", rate = "400 kHz" },
    { name = "terminal", bus = "usart1", path = "/dev/ttyUSB0", baud = "921600 baud" },
  },
  instruments = {
    { name = "cell", path = "/dev/ttyUSB1", delay = "4 ms",
      readings = { { signal = "thrust", column = 2, scale = "10 mN", zero = 5 } } },
  },
  signals = { speed = "told_speed" },
  safety = { phrase = "clear", longest = "60 s", limits = { { signal = "bus_current", low = "-1 A", high = "22 A" } } },
})";

Result<bench::BenchDescription> bench_of(const std::string& text) {
  const ScratchFolder folder;
  const std::string path = folder.file("b.lua");
  std::ofstream(path) << text;
  return read_bench(path);
}

std::string with(const std::string& what, const std::string& instead) {
  std::string text = kGood;
  text.replace(text.find(what), what.size(), instead);
  return text;
}

TEST(BenchFile, SaysWhatHangsWhere) {
  const auto got = bench_of(kGood);
  ASSERT_TRUE(got) << got.error().message();
  const bench::BenchDescription& b = got.value();
  EXPECT_EQ(b.pace, 0.5);
  EXPECT_EQ(b.late_ns, 300'000);
  EXPECT_EQ(b.late_share, 0.02);
  ASSERT_EQ(b.bridges.size(), 1u);
  EXPECT_EQ(b.bridges[0].kind, "cp2112");
  EXPECT_EQ(b.bridges[0].bus, 2);
  EXPECT_EQ(b.bridges[0].rate_Hz, 400e3);
  ASSERT_EQ(b.serials.size(), 1u);
  EXPECT_EQ(b.serials[0].baud, 921'600);
  ASSERT_EQ(b.readings().size(), 1u);
  EXPECT_EQ(b.readings()[0].dimension, Dimension::force);
  EXPECT_EQ(b.readings()[0].scale_SI, 0.01);
  EXPECT_EQ(b.readings()[0].zero, 5.0);
  EXPECT_EQ(b.instruments[0].delay_ns, 4'000'000);
  EXPECT_EQ(b.signals.at("speed"), "told_speed");
  ASSERT_EQ(b.safety.limits.size(), 1u);
  EXPECT_EQ(b.safety.limits[0].high, 22.0);
  EXPECT_EQ(b.safety.heartbeat_ns, 100'000'000);
}

TEST(BenchFile, RefusesWhatNoBenchCanBe) {
  const std::pair<std::string, std::string> cases[] = {
      {with("\"cp2112\"", "\"ft260\""), "bridge"},
      {with("i2c2", "spi1"), "bus"},
      {with("\"10 mN\"", "\"0 N\""), "scale"},
      {with("\"22 A\"", "\"-2 A\""), "high"},
      {with("\"22 A\"", "\"22 V\""), "high"},
      {with("phrase = \"clear\", ", ""), "phrase"},
      {with("/dev/ttyUSB1", "/dev/ttyUSB0"), "twice"},
      {with("name = \"cell\"", "name = \"terminal\""), "twice"},
      {with("longest = \"60 s\",", ""), "longest"},
      {with("pace = 0.5", "pace = 0"), "pace"},
      {with("delay = \"4 ms\"", "delay = \"4 ms\", colour = 1"), "colour"},
      {with("readings = { { signal = \"thrust\", column = 2, scale = \"10 mN\", zero = 5 } }",
            "readings = {}"),
       "readings"},
  };
  for (const auto& [text, word] : cases) {
    const auto got = bench_of(text);
    ASSERT_FALSE(got) << word;
    EXPECT_EQ(got.error().kind, ErrorKind::bad_input);
    EXPECT_NE(got.error().message().find(word), std::string::npos) << got.error().message();
  }
}

TEST(BenchFile, ALineIsSaidToCarryMavlink) {
  const auto of_kind = [](const std::string& kind) {
    return bench_of(
        with("{ name = \"terminal\"", "{ name = \"radio\", kind = \"" + kind +
                                          "\", bus = \"usart2\", path = \"/dev/ttyUSB3\" },\n"
                                          "    { name = \"terminal\""));
  };
  const auto got = of_kind("mavlink");
  ASSERT_TRUE(got) << got.error().message();
  ASSERT_EQ(got.value().serials.size(), 2u);
  EXPECT_TRUE(got.value().serials[0].mavlink);
  EXPECT_FALSE(got.value().serials[1].mavlink);
  const auto other = of_kind("telnet");
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message().find("kind"), std::string::npos) << other.error().message();
}

TEST(BenchFile, IdsForNodesWithoutOneAreByUniqueIdOrOfARange) {
  const auto of = [](const std::string& allocation) {
    return bench_of(with("{ name = \"terminal\"",
                         "{ name = \"bus\", bus = \"can1\", interface = \"can0\", allocation = { " +
                             allocation + " } },\n    { name = \"terminal\""));
  };
  const std::string id = "00112233445566778899aabbCCddeeff";
  const auto got = of("lowest = 100, node = 11, ids = { [\"" + id + "\"] = 20 }");
  ASSERT_TRUE(got) << got.error().message();
  const bench::CanBusLink& link = got.value().cans.at(0);
  EXPECT_EQ(link.ids.lowest, 100);
  EXPECT_EQ(link.ids.highest, 125);
  EXPECT_EQ(link.allocator, 11);
  ASSERT_EQ(link.ids.kept.size(), 1u);
  EXPECT_EQ(link.ids.kept[0].second, 20);
  EXPECT_EQ(link.ids.kept[0].first[12], 0xCC);
  EXPECT_EQ(link.ids.kept[0].first[1], 0x11);
  const std::pair<std::string, std::string> cases[] = {
      {"lowest = 0", "lowest"},
      {"highest = 126", "highest"},
      {"lowest = 20, highest = 19", "below lowest"},
      {"ids = { [\"0011\"] = 20 }", "16 bytes in hex"},
      {"ids = { [\"" + id.substr(0, 30) + "zz\"] = 20 }", "16 bytes in hex"},
      {"ids = { [\"" + id + "\"] = 126 }", "126"},
      {"ids = { [\"" + id + "\"] = 20, [\"" + std::string(32, '1') + "\"] = 20 }",
       "another one has"},
      {"ids = { [\"" + id + "\"] = 20, [\"00112233445566778899AABBCCDDEEFF\"] = 21 }", "twice"},
      {"node = 11, ids = { [\"" + id + "\"] = 11 }", "allocator's own"},
      {"colour = 1", "colour"},
  };
  for (const auto& [text, word] : cases) {
    const auto refused = of(text);
    ASSERT_FALSE(refused) << text;
    EXPECT_NE(refused.error().message().find(word), std::string::npos) << refused.error().message();
  }
}

TEST(BenchFile, APodsHostIsOnALineOrOnCan) {
  const auto line = bench_of(
      with("{ name = \"terminal\"",
           "{ name = \"pod\", pod = \"p\", path = \"/dev/ttyUSB3\" },\n    { name = \"terminal\""));
  ASSERT_TRUE(line) << line.error().message();
  ASSERT_EQ(line.value().pods.size(), 1u);
  EXPECT_EQ(line.value().pods[0].board, "p");
  EXPECT_EQ(line.value().pods[0].path, "/dev/ttyUSB3");
  const auto can = bench_of(
      with("{ name = \"terminal\"",
           "{ name = \"pod\", pod = \"p\", interface = \"can0\" },\n    { name = \"terminal\""));
  ASSERT_TRUE(can) << can.error().message();
  ASSERT_EQ(can.value().pods.size(), 1u);
  EXPECT_EQ(can.value().pods[0].can.interface, "can0");
  EXPECT_EQ(can.value().pods[0].path, "");
  const auto twice = bench_of(
      with("{ name = \"terminal\"",
           "{ name = \"pod\", pod = \"p\", path = \"/dev/ttyUSB0\" },\n    { name = \"terminal\""));
  ASSERT_FALSE(twice);
  EXPECT_NE(twice.error().message().find("twice"), std::string::npos);
}

const std::string kEyes =
    R"(analyser = { driver = "fx2lafw", rate = "24 MHz", marker = "/dev/ttyUSB2",
    channels = { D0 = "i2c2_scl", D1 = "i2c2_sda", D4 = "spi1_sck", D7 = "marker" }, clocks = { spi1 = "5 MHz" } },
  probe = { interface = "interface/stlink.cfg", target = "target/stm32f1x.cfg", idle = "fw::idle" },
  safety)";

std::string with_eyes(const std::string& what, const std::string& instead) {
  std::string eyes = kEyes;
  if (!what.empty()) eyes.replace(eyes.find(what), what.size(), instead);
  return with("safety", eyes);
}

TEST(BenchFile, NamesTheClipsOfAnAnalyserAndAProbe) {
  const auto got = bench_of(with_eyes("", ""));
  ASSERT_TRUE(got) << got.error().message();
  ASSERT_TRUE(got.value().analyser && got.value().probe);
  EXPECT_EQ(got.value().analyser->channels.at("D1"), "i2c2_sda");
  EXPECT_EQ(got.value().analyser->rate_Hz, 24e6);
  EXPECT_TRUE(got.value().analyser->sees("i2c2"));
  EXPECT_FALSE(got.value().analyser->sees("i2c"));
  EXPECT_FALSE(got.value().analyser->sees("pin_led"));
  EXPECT_EQ(got.value().probe->target, "target/stm32f1x.cfg");
}

TEST(BenchFile, RefusesClipsThatCannotBeRead) {
  const std::pair<std::string, std::string> cases[] = {
      {with_eyes("\"24 MHz\"", "\"12 MHz\""), "12 MHz is too slow for spi1 at 5000 kHz"},
      {with_eyes("\"24 MHz\"", "\"1 MHz\""), "1 MHz is too slow for i2c2 at 400 kHz"},
      {with_eyes("i2c2_sda", "i2c2_sdx"), "is no name of a wire"},
      {with_eyes("i2c2_sda", "i2c2_scl"), "has two clips"},
      {with_eyes(", D7 = \"marker\"", ""), "no clip is on the marker"},
      {with_eyes("/dev/ttyUSB2", "/dev/ttyUSB0"), "twice"},
      {with_eyes("interface/stlink.cfg", "x; shutdown"), "holds a character"},
  };
  for (const auto& [text, word] : cases) {
    const auto got = bench_of(text);
    ASSERT_FALSE(got) << word;
    EXPECT_NE(got.error().message().find(word), std::string::npos) << got.error().message();
  }
}

}  // namespace
}  // namespace whirl
