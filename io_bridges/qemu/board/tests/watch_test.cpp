// The watcher's contexts: whose time it is, tasks and their stacks, exceptions that nest and chain.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "io_bridges/qemu/board/tests/told_core.hpp"

namespace whirl::board {
namespace {

TEST(Watch, AnotherTasksTimeIsNotTheCallers) {
  Core core;
  core.call(1, kTask, 0x08000011);
  core.now = 100;
  core.enter(15, kTask - 8);
  core.now = 110;
  core.leave_to_thread(15, kOther);  // a task that has never run
  core.now = 1000;
  core.enter(15, kOther - 16);
  core.now = 1010;
  core.leave_to_thread(15, kTask - 8);
  core.now = 1050;
  core.come_back(0x08000010, kTask);
  EXPECT_EQ(core.calls(), (Calls{{1, 140}}));
}

// ChibiOS: the handler leaves the interrupted frame and returns below it, into code that switches in
// thread mode; later a supervisor call drops that frame.
TEST(Watch, ASwitchInThreadModeBelowTheFrameBelongsToTheTask) {
  Core core;
  core.watch.enter_function(9, core.thread(kOther, 0x08000021));  // the other task has run before
  core.now = 5;
  core.watch.stack_pointer_loads(core.thread(kOther - 8), true);
  core.call(1, kTask, 0x08000011);
  core.now = 100;
  core.enter(15, kTask - 8);
  core.leave_to_thread(15, kTask - 8 - kFrame);
  core.now = 130;
  core.watch.stack_pointer_loads(core.thread(kTask - 60), true);
  core.now = 900;
  core.come_back(0x08000020, kOther);  // the other task goes on
  core.now = 1000;
  core.watch.stack_pointer_loads(core.thread(kOther - 8), true);
  core.now = 1010;
  core.enter(11, kTask - 8 - kFrame);  // the supervisor call
  core.leave_to_thread(11, kTask - 8);
  core.now = 1050;
  core.come_back(0x08000010, kTask);
  EXPECT_EQ(core.calls(), (Calls{{9, 5 + 770}, {1, 125 + 50}}));
  EXPECT_EQ(core.watch.stacks().count(), 2u);
}

TEST(Watch, WhatHasNotReturnedIsToldAtTheEndWithoutALength) {
  Core core;
  core.call(1, kTask, 0x08000011);
  core.enter(15, kTask - 8);
  core.call(2, kMain, 0xFFFFFFF9);
  core.now = 50;
  core.watch.run_ends(core.now);
  EXPECT_EQ(core.calls(), (Calls{{1, -1}, {2, -1}}));
}

TEST(Watch, WhatTheCoreTakesToEnterAndLeaveIsNobodysTime) {
  Core core;
  core.call(1, kTask, 0x08000011);
  core.now = 100;
  const CoreState before = core.thread(kTask - 8);
  core.now = 112;
  core.watch.exception(before, core.handler(15, kToThread));
  core.now = 150;
  const CoreState leaving = core.returning(15);
  core.now = 160;
  core.watch.exception(leaving, core.thread(kTask - 8));
  core.now = 200;
  core.come_back(0x08000010, kTask);
  EXPECT_EQ(core.calls(), (Calls{{1, 140}}));
}

TEST(Watch, ATailChainedExceptionIsNobodysTimeButItsOwn) {
  Core core;
  core.call(1, kTask, 0x08000011);
  core.now = 10;
  core.enter(20, kTask);
  core.watch.enter_function(2, core.handler(20, kToThread));
  core.now = 30;
  core.leave_to(20, 20);  // behind itself
  core.watch.enter_function(2, core.handler(20, kToThread));
  core.now = 70;
  core.leave_to(20, 21);
  core.now = 80;
  core.leave_to_thread(21, kTask);
  core.now = 85;
  core.come_back(0x08000010, kTask);
  EXPECT_EQ(core.calls(), (Calls{{2, 20}, {2, 40}, {1, 15}}));
}

TEST(Watch, AHandlerBelowAnotherOneGoesOnWithItsTime) {
  Core core;
  core.enter(20, kTask);
  core.watch.enter_function(2, core.handler(20, kToThread));
  for (int i = 0; i < 3; ++i) {
    core.now += 10;
    core.nest(20, 30);
    core.now += 100;
    core.leave_to(30, 20);
  }
  core.now += 10;
  core.leave_to_thread(20, kTask);
  EXPECT_EQ(core.calls(), (Calls{{2, 40}}));
}

TEST(Watch, AJumpOutOfACallEndsIt) {
  Core core;
  core.call(1, kTask - 32, 0x08000011);
  core.now = 500;
  core.watch.stack_pointer_loads(core.thread(kTask - 64), false);  // longjmp
  core.now = 510;
  core.call(1, kTask - 32, 0x08000011);
  core.now = 530;
  core.come_back(0x08000010, kTask - 32);
  EXPECT_EQ(core.calls(), (Calls{{1, 20}}));
}

TEST(Watch, AFunctionThatLoopsToItsFirstInstructionIsOneCall) {
  Core core;
  for (int i = 0; i < 5; ++i, core.now += 10) core.call(1, kTask, 0x08000011);
  core.come_back(0x08000010, kTask);
  EXPECT_EQ(core.calls(), (Calls{{1, 50}}));
}

TEST(Watch, AnArrayOfVariableLengthIsNoTask) {
  Core core;
  core.call(1, kTask, 0x08000011);
  core.now = 10;
  core.watch.stack_pointer_loads(core.thread(kTask - 16), false);
  core.now = 20;
  core.call(2, kTask - 5000, 0x08000031);
  core.now = 30;
  core.come_back(0x08000030, kTask - 5000);
  core.come_back(0x08000010, kTask);
  EXPECT_EQ(core.calls(), (Calls{{2, 10}, {1, 30}}));
  EXPECT_EQ(core.watch.stacks().count(), 1u);
}

// Firmware that means harm: any stack pointer, any order of exceptions, returns to any of them.
TEST(Watch, WildFirmwareCostsLittleMemoryAndGivesNoNegativeTime) {
  std::mt19937 random(1);
  const auto any = [&random] { return static_cast<std::uint32_t>(random()); };
  Core core;
  std::vector<std::uint32_t> active = {0};
  const auto state = [&] { return CoreState{core.now, active.back(), any() & ~3u, any(), kCode}; };
  for (int i = 0; i < 200000; ++i, core.now += any() % 50) {
    CoreState before = state();
    if (any() % 4 == 0) core.watch.enter_function(static_cast<std::uint16_t>(any() % 3), before);
    if (any() % 4 == 0) core.watch.return_site(before.lr & ~1u, before);
    if (any() % 4 == 0 && active.back() == 0)
      core.watch.stack_pointer_loads(before, any() % 2 == 0);
    const std::uint32_t next = 1 + any() % 97;
    if (any() % 2 == 0 && active.size() > 1) {
      before.pc = kToThread & ~1u;
      active.resize(1 + any() % (active.size() - 1));
    } else if (std::find(active.begin(), active.end(), next) == active.end()) {
      active.push_back(next);
    } else {
      continue;
    }
    core.watch.exception(before, state());
    ASSERT_LE(core.watch.stacks().count(), 64u);
  }
  EXPECT_GT(core.calls().size(), 100u);
  for (const auto& [number, execution_ns] : core.calls()) ASSERT_GE(execution_ns, 0) << number;
}

}  // namespace
}  // namespace whirl::board
