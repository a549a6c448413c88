// The runner of the fuzzers, with scripts in the place of libFuzzer's programs.
#include "harness/cli/parser_fuzzers.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "harness/tests/fake.hpp"

namespace whirl::test {
namespace {

// A parser of this name, whose program prints its arguments and this, and ends with this code.
void add_parser(const FakeRoot& root, const std::string& name, const std::string& says, int code) {
  const std::string program = "build/fuzz/harness/fuzz/fuzz_" + name;
  root.write("harness/fuzz/corpus/" + name + "/seed", "x");
  root.write(program, "#!/bin/sh\necho \"$@\"\necho '" + says + "'\nexit " + std::to_string(code));
  std::filesystem::permissions(root.path() + "/" + program, std::filesystem::perms::owner_all);
}

struct Printed {
  int code;
  std::string out;
};

Printed run(cli::ParserFuzzOptions options) {
  const auto here = std::filesystem::current_path();
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const int code = run_parser_fuzzers(options);
  ::testing::internal::GetCapturedStderr();
  std::filesystem::current_path(here);
  return {code, ::testing::internal::GetCapturedStdout()};
}

TEST(ParserFuzzers, AFindingIsExitCodeOneWithTheInputThatShowsIt) {
  const FakeRoot root;
  add_parser(root, "good", "stat::number_of_executed_units: 4711", 0);
  EXPECT_EQ(run({.root = root.path()}).code, 0);
  add_parser(root, "bad", "artifact_prefix; Test unit written to /tmp/bad-crash-12", 77);
  const Printed both = run({.root = root.path()});
  EXPECT_EQ(both.code, 1);
  EXPECT_NE(both.out.find("/tmp/bad-crash-12"), std::string::npos) << both.out;
  EXPECT_NE(both.out.find("4711"), std::string::npos) << both.out;
  EXPECT_EQ(run({.root = root.path(), .only = {"good"}}).code, 0);
}

TEST(ParserFuzzers, OneThatDiesWithoutAWordIsAFindingToo) {
  const FakeRoot root;
  add_parser(root, "silent", "", 3);
  EXPECT_EQ(run({.root = root.path()}).code, 1);
}

TEST(ParserFuzzers, RunsAreCountedOrTimedAsAsked) {
  const FakeRoot root;
  add_parser(root, "one", "", 0);
  const std::string log = "build/fuzz/logs/one.log";
  run({.root = root.path(), .seconds = 12.0});
  EXPECT_NE(root.read(log).find("-max_total_time=12"), std::string::npos);
  run({.root = root.path(), .runs = 10'000'000, .seed = 5});
  EXPECT_NE(root.read(log).find("-runs=10000000"), std::string::npos);
  EXPECT_NE(root.read(log).find("-seed=5"), std::string::npos);
}

TEST(ParserFuzzers, WhatIsNotThereIsBadUsage) {
  const FakeRoot root;
  EXPECT_EQ(run({.root = root.path()}).code, 2);  // no parser at all
  add_parser(root, "one", "", 0);
  EXPECT_EQ(run({.root = root.path(), .only = {"two"}}).code, 2);
  root.write("harness/fuzz/corpus/unbuilt/seed", "x");
  EXPECT_EQ(run({.root = root.path()}).code, 2);
}

}  // namespace
}  // namespace whirl::test
