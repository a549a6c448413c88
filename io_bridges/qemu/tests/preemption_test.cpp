// Execution times of what is preempted, and stacks of tasks, against counts of instructions (8 ns each)
// that are made by hand in images/preempted.c and images/rtos.c.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "base/json_text.hpp"
#include "base/near.hpp"
#include "io_bridges/qemu/tests/board_run.hpp"

namespace whirl::board_test {
namespace {

constexpr std::int64_t kInstruction_ns = 8;

struct Call {
  std::int64_t entry_ns, return_ns, execution_ns;
};

std::map<std::string, std::vector<Call>> calls_of(const std::string& name,
                                                  const std::vector<std::string>& watch,
                                                  int milliseconds) {
  const BoardRun run = run_for({image(name), watch}, milliseconds);
  EXPECT_EQ(run.error.what, "");
  EXPECT_TRUE(run.of(io::Kind::cpu_fault).empty());
  std::map<std::string, std::vector<Call>> calls;
  for (const Message* message : run.of(io::Kind::function_call)) {
    const auto call = message->as<io::FunctionCall>();
    calls[watch.at(message->head.port)].push_back(
        {call.entry_ns, message->head.t_ns, call.execution_ns});
  }
  return calls;
}

const std::map<std::string, int> kPreempted = {{"spin", 202},          {"work", 1017},
                                               {"irq31_handler", 619}, {"irq30_handler", 615},
                                               {"irq29_handler", 615}, {"irq28_handler", 205}};

// On MSP, then on PSP.
void expect_counted(const std::vector<std::string>& watch) {
  auto calls = calls_of("preempted", watch, 1);
  for (const std::string& name : watch) {
    EXPECT_EQ(calls[name].size(), name == "spin" ? 2 * 15u : 2u) << name;
    for (const Call& call : calls[name]) {
      EXPECT_EQ(call.execution_ns, kPreempted.at(name) * kInstruction_ns) << name;
    }
  }
}

TEST(Preemption, NestedThreeDeepAndTailChainedEveryFunctionTakesItsInstructions) {
  std::vector<std::string> all;
  all.reserve(kPreempted.size());
  for (const auto& [name, instructions] : kPreempted) all.push_back(name);
  expect_counted(all);
}

TEST(Preemption, AFunctionTakesItsInstructionsAlsoWhenNothingElseIsWatched) {
  for (const auto& [name, instructions] : kPreempted) expect_counted({name});
}

TEST(Preemption, ResponseIsExecutionAndAllThatCameOnTop) {
  auto calls = calls_of("preempted", {"work", "irq31_handler", "irq30_handler"}, 1);
  const auto response = [&](const std::string& name, std::size_t i) {
    return (calls.at(name).at(i).return_ns - calls.at(name).at(i).entry_ns) / kInstruction_ns;
  };
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(response("irq30_handler", i), 615 + 615) << i;
    EXPECT_EQ(response("irq31_handler", i), 619 + 615 + 615) << i;
    EXPECT_EQ(response("work", i), 1017 + 619 + 615 + 615 + 205) << i;
  }
}

// The first call is as long as the second: the longest is the first.
TEST(Preemption, TheLongestCallIsToldWithItsCallersAndWhatCameBetween) {
  const std::vector<std::string> watch = {"work", "spin", "irq30_handler"};
  const BoardRun run = run_for({image("preempted"), watch}, 1);
  const auto statistics = run.of(io::Kind::statistics);
  ASSERT_EQ(statistics.size(), 1u);
  const auto said = parse_json(run.text_of(*statistics[0])).at("watched");
  ASSERT_EQ(said.size(), watch.size());
  const auto& work = said[0].at("worst_response");
  EXPECT_EQ(said[0].at("name"), "work");
  EXPECT_EQ(work.at("in"), "thread");
  EXPECT_EQ(work.at("execution_ns"), 1017 * kInstruction_ns);
  EXPECT_EQ(work.at("response_ns"), (1017 + 619 + 615 + 615 + 205) * kInstruction_ns);
  const auto cycles = [](int instructions) {  // of 168 MHz
    return instructions * static_cast<double>(kInstruction_ns) * 0.168;
  };
  EXPECT_TRUE(near(work.at("execution_cycles"), cycles(1017),
                   stated(3, "whole cycles of each of five stretches")));
  const auto function = [](const nlohmann::json& call, std::size_t frame) {
    const auto line = call.at("path").at(frame).get<std::string>();
    return line.substr(0, line.find('+'));
  };
  ASSERT_EQ(work.at("path").size(), 2u) << text_of(work);
  EXPECT_EQ(function(work, 0), "main");
  EXPECT_EQ(function(work, 1), "reset_handler");
  // In order of their numbers, each with what it ran itself.
  const int ran[] = {205, 615, 615, 619};
  ASSERT_EQ(work.at("between").size(), 4u) << text_of(work);
  for (int i = 0; i < 4; ++i) {
    const auto& one = work.at("between")[static_cast<std::size_t>(i)];
    EXPECT_EQ(one.at("exception"), "exception " + std::to_string(44 + i) + " (irq" +
                                       std::to_string(28 + i) + "_handler)");
    EXPECT_EQ(one.at("times"), 1);
    EXPECT_EQ(one.at("ran_ns"), ran[i] * kInstruction_ns);
  }
  const auto& spin = said[1].at("worst_execution");  // the first of 30 that are equal
  EXPECT_EQ(spin.at("in"), "thread");
  ASSERT_EQ(spin.at("path").size(), 3u) << text_of(spin);
  EXPECT_EQ(function(spin, 0), "work");
  EXPECT_EQ(function(spin, 1), "main");
  const auto& handler = said[2].at("worst_response");
  EXPECT_EQ(handler.at("in"), "exception 46 (irq30_handler)");
  EXPECT_TRUE(handler.at("path").empty());
  EXPECT_EQ(handler.at("exceptions"), 1);
}

TEST(Rtos, TasksTakeTheirInstructionsWhoeverPreemptsThem) {
  auto calls = calls_of("rtos", {"work_fast", "work_slow"}, 100);
  EXPECT_GE(calls["work_fast"].size(), 48u);
  for (const Call& call : calls["work_fast"]) EXPECT_EQ(call.execution_ns, 205 * kInstruction_ns);
  EXPECT_GE(calls["work_slow"].size(), 6u);
  for (const Call& call : calls["work_slow"]) {
    EXPECT_EQ(call.execution_ns, 280005 * kInstruction_ns);
    EXPECT_GT(call.return_ns - call.entry_ns, (280005 + 205) * kInstruction_ns);
  }
}

TEST(Rtos, TheTickHasItsPeriod) {
  const auto ticks = calls_of("rtos", {"systick_handler"}, 100)["systick_handler"];
  ASSERT_GE(ticks.size(), 98u);
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    const auto period_ns = static_cast<double>(ticks[i].entry_ns - ticks[i - 1].entry_ns);
    EXPECT_TRUE(near(period_ns, 1e6, stated(kInstruction_ns, "one instruction")));
  }
}

TEST(Rtos, EachTaskHasItsStack) {
  const BoardRun run = run_for({image("rtos"), {}}, 50);
  const auto statistics = run.of(io::Kind::statistics);
  ASSERT_EQ(statistics.size(), 1u);
  const auto said = parse_json(run.text_of(*statistics[0]));
  std::map<std::string, int> used;
  for (const auto& stack : said.at("task_stacks")) used[stack.at("stack")] = stack.at("used_bytes");
  const std::map<std::string, int> counted = {
      {"fast_stack", 100}, {"slow_stack", 400 + 64}, {"idle_stack", 64}};
  EXPECT_EQ(used, counted) << text_of(said);
}

}  // namespace
}  // namespace whirl::board_test
