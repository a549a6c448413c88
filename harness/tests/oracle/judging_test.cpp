// Facts of the judging, one by one: a few lines of Lua against signals and messages given by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "harness/tests/oracle/by_hand.hpp"

namespace whirl::oracle {
namespace {

constexpr std::int64_t kUs = 1000;

TEST(Judging, WhatNeverChangedHasNotSettledWithinAShareOfItsChange) {
  const auto settled = [](auto at) {
    return only(
        with_signal("t:wait '300 ms' local r = t:record('x', '500 ms')"
                    " t:expect(r:settled '5 %'):at_most '1 s'",
                    at));
  };
  EXPECT_TRUE(std::isnan(settled([](int) { return 2.0; }).measured));
  EXPECT_EQ(settled([](int ms) { return ms < 400 ? 1.0 : 2.0; }).measured, 0.1);
}

TEST(Judging, AShareOfAChangeWantsItsReferenceOfTwoHundredMilliseconds) {
  const auto settled = [](const std::string& wait) {
    return only(with_signal("t:wait '" + wait +
                                "' local r = t:record('x', '500 ms')"
                                " t:expect(r:settled '5 %'):at_most '1 s'",
                            [](int ms) { return ms < 300 ? 1.0 : 2.0; }))
        .verdict;
  };
  EXPECT_EQ(settled("199 ms"), results::Verdict::fail);
  EXPECT_EQ(settled("200 ms"), results::Verdict::pass);
}

// Entries every 5 ms; the window ends at 100 ms, in the midst of the call that began at 99.9 ms.
TEST(Judging, ACallThatIsStillRunningAtTheEndOfAWindowHasCome) {
  Scenario s = playing(
      "t:budget 'fw::task' { period = '5 ms', jitter = '1 us', during = '100 ms' } t:wait '110 "
      "ms'");
  for (std::int64_t t = 4'900 * kUs; t < 110 * kMs; t += 5 * kMs) add_call(s, t, t + 300 * kUs);
  EXPECT_TRUE(passes(s));
}

// The run ends with the window: the call that began at 99.9 ms never returns.
TEST(Judging, ACallThatIsStillRunningAtTheEndOfTheRunHasComeButHasNoLength) {
  Scenario s = playing(
      "t:budget 'fw::task' { period = '5 ms', jitter = '1 us', response = '400 us', "
      "during = '100 ms' } t:wait '100 ms'");
  for (std::int64_t t = 4'900 * kUs; t < 99 * kMs; t += 5 * kMs) add_call(s, t, t + 300 * kUs);
  EXPECT_FALSE(passes(s));
  s.messages.push_back(
      {100 * kMs, [](io::Batch& batch) {
         batch.add(io::Kind::function_call, 1, 100 * kMs, io::FunctionCall{99'900 * kUs, -1, -1});
       }});
  EXPECT_TRUE(passes(s));
}

// Executions of 95 us. The clock of cycles is good for 10 %.
TEST(Judging, ALimitThatIsMetByLessThanTheClockIsAccurateIsMarginal) {
  const auto judged = [](const std::string& budget) {
    Scenario s = playing("t:budget 'fw::task' { " + budget + ", during = '50 ms' } t:wait '60 ms'");
    for (std::int64_t t = 1 * kMs; t < 60 * kMs; t += kMs) add_call(s, t, t + 100 * kUs, 95 * kUs);
    return only(s);
  };
  const auto near = judged("execution = '100 us'");
  EXPECT_EQ(near.verdict, results::Verdict::pass);
  EXPECT_TRUE(near.marginal);
  const auto far = judged("execution = '106 us'");
  EXPECT_EQ(far.verdict, results::Verdict::pass);
  EXPECT_FALSE(far.marginal);
  const auto asked = judged("execution = '100 us', margin = '10 %'");
  EXPECT_EQ(asked.verdict, results::Verdict::fail);
  EXPECT_FALSE(asked.marginal);
  EXPECT_TRUE(whirl::near(*asked.high, 90.0, stated(1e-9, "round-off")));
  EXPECT_NE(asked.note.find("100 us less 10 %"), std::string::npos) << asked.note;
  EXPECT_EQ(judged("execution = '106 us', margin = '10 %'").verdict, results::Verdict::pass);
}

// A board that ends with these words.
results::Expectation stack(const std::string& budget, const std::string& words) {
  Scenario s = playing("t:budget 'stack' { " + budget + " } t:wait '20 ms'");
  s.last_words = [words](io::Batch& rest) {
    rest.add(io::Kind::statistics, 0, 20 * kMs, words.data(),
             static_cast<std::uint32_t>(words.size()));
  };
  return only(s);
}

constexpr const char* kStacks = R"({"stack_used_bytes": 1536, "task_stacks": [
    {"stack": "idle_stack", "top": "0x1", "used_bytes": 64}]})";

TEST(Judging, AStackIsHeldToItsDepthAndToTheMarginThatIsAsked) {
  const auto at_limit = stack("depth = '1.5 KiB'", kStacks);
  EXPECT_EQ(at_limit.verdict, results::Verdict::pass);
  EXPECT_EQ(at_limit.name, "stack depth");
  EXPECT_EQ(at_limit.measured, 1.5);
  EXPECT_EQ(at_limit.note, "1536 B; 0 % of the limit left");
  EXPECT_EQ(stack("depth = '1535 B'", kStacks).verdict, results::Verdict::fail);
  EXPECT_EQ(stack("depth = '2 KiB', margin = '25 %'", kStacks).verdict, results::Verdict::pass);
  EXPECT_EQ(stack("depth = '2 KiB', margin = '26 %'", kStacks).verdict, results::Verdict::fail);
}

TEST(Judging, ATasksStackIsNamedByItsArray) {
  const auto idle = stack("depth = '64 B', of = 'idle_stack'", kStacks);
  EXPECT_EQ(idle.verdict, results::Verdict::pass);
  EXPECT_EQ(idle.name, "stack of idle_stack depth");
  EXPECT_EQ(stack("depth = '63 B', of = 'idle_stack'", kStacks).verdict, results::Verdict::fail);
}

TEST(Judging, AStackThatNoBoardToldOfIsNeverAPass) {
  for (const char* words : {"", "[]", "{}", R"({"stack_used_bytes": 0})",
                            R"({"stack_used_bytes": "9"})", R"({"stack_used_bytes": -1})"}) {
    const auto unknown = stack("depth = '1 MiB'", words);
    EXPECT_EQ(unknown.verdict, results::Verdict::fail) << words;
    EXPECT_NE(unknown.note.find("the board did not tell"), std::string::npos) << unknown.note;
  }
  const auto nobody = stack("depth = '1 MiB', of = 'x'", kStacks);
  EXPECT_EQ(nobody.verdict, results::Verdict::fail);
  EXPECT_EQ(nobody.note, "no task was seen to run on a stack 'x'");
}

TEST(Judging, AnAnswerThatComesAtTheLimitIsInTime) {
  for (int limit : {43, 55, 60}) {
    Scenario s = playing("t:wait '65 ms' t:ask('hello', nil, '" + std::to_string(limit) +
                         " ms') t:wait '9 ms'");
    s.answers["hello"] = {limit, "yes"};
    EXPECT_TRUE(passes(s)) << limit;
    s.answers["hello"].after_ms += 1;
    EXPECT_FALSE(passes(s)) << limit;
  }
}

}  // namespace
}  // namespace whirl::oracle
