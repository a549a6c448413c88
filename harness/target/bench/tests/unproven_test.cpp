// What nobody has proven without hardware: each bench is told what concerns it, and the guide tells all of it.
#include "harness/target/bench/unproven.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/whole_file.hpp"

namespace whirl::bench {
namespace {

bool tells(const BenchDescription& bench, LineEnds lines, const std::string& words) {
  const auto all = unproven(bench, lines);
  return std::any_of(all.begin(), all.end(), [&](const Unproven& item) {
    return item.text().find(words) != std::string::npos;
  });
}

TEST(Unproven, ABenchIsToldWhatConcernsItAndNothingElse) {
  const BenchDescription none;
  EXPECT_EQ(unproven(none, {}).size(), 2u);  // a board, and its wires
  BenchDescription bench;
  const auto adds = [&](const std::string& words, LineEnds lines = {}) {
    EXPECT_TRUE(tells(bench, lines, words)) << words;
    EXPECT_FALSE(tells(none, {}, words)) << words;
  };
  bench.cans.push_back({"bus", "can0"});
  for (const char* words : {"hardware time stamps", "bus-off", "USB CAN adapter", "other makers"}) {
    adds(words);
  }
  EXPECT_FALSE(tells(bench, {}, "a pod of metal"));
  bench = {};
  bench.pods.push_back({.name = "pod", .board = "pod", .path = "", .can = {}});
  adds("a pod of metal");
  adds("bus-off");
  bench.pods[0].path = "/dev/ttyUSB0";
  EXPECT_FALSE(tells(bench, {}, "bus-off"));
  adds("USB serial adapter");
  bench = {};
  bench.serials.push_back({"line", "/dev/ttyUSB0"});
  adds("SBUS", {.receiver = true});
  adds("GPS", {.gps = true});
  adds("command line", {.commands = true});
  bench.serials[0].mavlink = true;
  adds("radio's air");
  bench = {};
  bench.bridges.push_back({"throttle", "cp2112", ""});
  adds("real USB bridge");
  bench.instruments.push_back({.name = "cell", .path = "/dev/ttyUSB1", .readings = {}});
  adds("scales, zeros and delays");
  bench.analyser.emplace();
  for (const char* words : {"streams for minutes", "the marker", "clips on copper"}) adds(words);
  bench.probe.emplace();
  adds("debug probe");
}

TEST(Unproven, EachIsSaidOnce) {
  std::set<std::string> seen;
  for (const Unproven& item : all_unproven()) EXPECT_TRUE(seen.insert(item.what).second);
}

TEST(Unproven, TheGuideHasTheSameWords) {
  const auto guide = read_whole_file(std::string(WHIRL_ROOT) + "/docs/bench.md");
  ASSERT_TRUE(guide.ok());
  for (const Unproven& item : all_unproven()) {
    EXPECT_NE(guide.value().find("* " + item.text() + "\n"), std::string::npos) << item.text();
  }
}

}  // namespace
}  // namespace whirl::bench
