// whirl export: what a run left, once more and in full.
#include <gtest/gtest.h>

#include "harness/tests/plans.hpp"

namespace whirl::test {
namespace {

class Export : public testing::Test {
 protected:
  void SetUp() override {
    root_.write("test_plans/p.lua",
                plan_text("t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\""));
    ASSERT_EQ(whirl(root_, {"run"}).code, 0);
  }
  std::string run() const { return root_.path() + "/results/runs/latest"; }
  std::string kept(const std::string& file) const {
    return root_.read("results/runs/latest/" + file);
  }

  FakeRoot root_;
};

TEST_F(Export, TheFilesOfTheRunComeOutAsTheyWere) {
  const Outcome outcome = whirl(root_, {"export", run(), "--csv", "--out", root_.path() + "/out"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("/out: 1 s of truth.csv, bus.csv, "), std::string::npos)
      << outcome.out;
  for (const char* file : {"truth.csv", "bus.csv", "serial.txt"}) {
    EXPECT_EQ(root_.read(std::string("out/") + file), kept(file)) << file;
  }
  EXPECT_GT(kept("truth.csv").size(), 1000u);
  EXPECT_GT(kept("bus.csv").size(), 1000u);
}

TEST_F(Export, EveryMessageThatCrossedIsInIt) {
  EXPECT_EQ(kept("messages.csv"), "");  // not of each run
  ASSERT_EQ(whirl(root_, {"export", run() + "/messages.whirl", "--csv"}).code, 0);
  const std::string all = kept("messages.csv");
  EXPECT_NE(all.find("\n0.003100000,,0,data_ready,0,"), std::string::npos) << all.substr(0, 800);
  for (const char* kind : {",1,fault,", ",0,statistics,"}) {
    EXPECT_EQ(all.find(kind), std::string::npos) << kind;  // nobody sent these
  }
  EXPECT_NE(all.find(",0,i2c_transaction,3,,\"start_ns="), std::string::npos);
  EXPECT_NE(all.find("length=3;kept=3;bytes=1002"), std::string::npos);
  EXPECT_NE(all.find(",0,busy_time,0,,\"since_ns=0;busy_ns=40000000\""), std::string::npos);
}

TEST_F(Export, WhatItCannotDoIsSaid) {
  const Outcome none = whirl(root_, {"export", run()});
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.err.find("no format is asked for (say one: --csv, --vcd)"), std::string::npos)
      << none.err;
  const Outcome gone = whirl(root_, {"export", root_.path() + "/results", "--csv"});
  EXPECT_EQ(gone.code, 2);
  EXPECT_NE(gone.err.find("results/messages.whirl: cannot be opened"), std::string::npos)
      << gone.err;
  EXPECT_EQ(root_.read("results/truth.csv"), "");  // and nothing is made
  const Outcome other = whirl(root_, {"export", run() + "/run.json", "--csv"});
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("is no file of a run's messages"), std::string::npos) << other.err;
}

// Of a file that was whole once: what the run made of it is not written over.
TEST_F(Export, OfADamagedFileWhatIsBeforeThatAndElsewhere) {
  const std::string whole = kept("messages.whirl");
  root_.write("cut/messages.whirl", whole.substr(0, whole.size() / 2));
  root_.write("cut/truth.csv", "of the run");
  const std::string messages = root_.path() + "/cut/messages.whirl";
  const Outcome refused = whirl(root_, {"export", root_.path() + "/cut", "--csv"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find(" of 1001 rows are there"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("nothing was written; --out FOLDER takes"), std::string::npos);
  EXPECT_EQ(root_.read("cut/truth.csv"), "of the run");
  const Outcome taken = whirl(root_, {"export", messages, "--csv", "--out", root_.path() + "/o"});
  EXPECT_EQ(taken.code, 2);
  const std::string part = root_.read("o/truth.csv");
  EXPECT_GT(part.size(), 1000u);
  EXPECT_EQ(part, kept("truth.csv").substr(0, part.size()));
}

}  // namespace
}  // namespace whirl::test
