// The watcher's messages: calls with their entry and return, latencies, and what a reset forgets.
#include <gtest/gtest.h>

#include "io_bridges/qemu/board/tests/told_core.hpp"

namespace whirl::board {
namespace {

// Raised at 0: an interrupt of the very first moment counts too.
TEST(Watch, ALatencyGoesFromTheRequestToTheHandlerAndWithItsCalls) {
  Core core;
  core.watch.line_changed(20, true, 0);
  core.now = 70;
  core.watch.line_changed(20, true, 70);  // it is still requested: the first time counts
  core.now = 100;
  core.enter(20, kTask);
  core.now = 110;
  core.watch.enter_function(2, core.handler(20, kToThread));
  core.now = 150;
  core.leave_to_thread(20, kTask);
  core.watch.line_changed(20, true, 160);
  core.now = 170;
  core.enter(20, kTask);
  core.leave_to_thread(20, kTask);
  core.now = 200;
  core.enter(20, kTask);  // nobody has requested it
  core.watch.enter_function(2, core.handler(20, kToThread));
  core.now = 210;
  core.leave_to_thread(20, kTask);
  EXPECT_EQ(all_told(core), (std::vector<Told>{{kLatency, 20, 0, 100},
                                               {kCall, 2, 110, 150, 100},
                                               {kLatency, 20, 160, 170},
                                               {kCall, 2, 200, 210, -1}}));
}

TEST(Watch, AReturnOfAnExceptionThatWasNeverTakenEndsNothing) {
  Core core;
  core.leave_to_thread(5, kTask);
  core.call(1, kTask, 0x08000011);
  core.now = 10;
  core.leave_to_thread(5, kTask);
  core.come_back(0x08000010, kTask);
  EXPECT_EQ(core.calls(), (Calls{{1, 10}}));
}

TEST(Watch, ARequestThatWasTakenBackHasNoLatency) {
  Core core;
  core.watch.line_changed(20, true, 10);
  core.watch.line_changed(20, false, 20);
  core.now = 30;
  core.enter(20, kTask);
  core.watch.line_changed(21, true, 40);
  core.watch.line_changed(21, false, 41);
  core.watch.line_changed(21, true, 45);
  core.now = 50;
  core.nest(20, 21);
  EXPECT_EQ(all_told(core), (std::vector<Told>{{kLatency, 21, 45, 50}}));
}

// The core has 256 exceptions at most; IPSR can say 511.
TEST(Watch, ExceptionsBeyondTheLastOneHaveNoLatency) {
  Core core;
  for (std::uint32_t exception : {255u, 256u, 300u, 511u}) {
    core.watch.line_changed(exception, true, 10);
    core.now = 30;
    core.enter(exception, kTask);
    core.leave_to_thread(exception, kTask);
  }
  EXPECT_EQ(all_told(core), (std::vector<Told>{{kLatency, 255, 10, 30}}));
}

TEST(Watch, AnExceptionIsTakenOrLeftOrNeither) {
  Core core;
  const CoreState thread = core.thread(kTask);
  EXPECT_FALSE(core.watch.exception(thread, thread));
  EXPECT_TRUE(core.watch.exception(thread, core.handler(20, kToThread)));
  EXPECT_TRUE(core.watch.exception(core.handler(20, kToThread), core.handler(30, kToHandler)));
  EXPECT_FALSE(core.watch.exception(core.returning(30), core.handler(20, kToThread)));
  EXPECT_TRUE(
      core.watch.exception(core.returning(20), core.handler(21, kToThread)));  // tail-chained
  EXPECT_FALSE(core.watch.exception(core.returning(21), thread));
}

// Every value of EXC_RETURN from 0xFFFFFFE0 on, with its lowest bit masked as a branch leaves it in PC.
TEST(Watch, AnyReturnOfAnExceptionEndsItsHandler) {
  for (std::uint32_t value : {0xFFFFFFE1u, 0xFFFFFFE9u, 0xFFFFFFF9u, 0xFFFFFFFDu}) {
    Core core;
    core.enter(1, kTask);
    core.watch.enter_function(2, core.handler(1, kToThread));
    core.now = 40;
    CoreState leaving = core.returning(1);
    leaving.pc = value & ~1u;
    core.watch.exception(leaving, core.thread(kTask));
    EXPECT_EQ(core.calls(), (Calls{{2, 40}})) << std::hex << value;
  }
  Core core;  // thread mode that wanders there leaves nothing
  core.call(1, kTask, 0x08000011);
  CoreState wild = core.thread(kTask);
  wild.pc = kToThread & ~1u;
  core.watch.exception(wild, core.handler(3, kToThread));
  core.now = 9;
  core.leave_to_thread(3, kTask - kFrame);
  EXPECT_EQ(core.watch.stacks().count(), 1u);
  core.come_back(0x08000010, kTask);
  EXPECT_EQ(core.calls(), (Calls{{1, 0}}));
}

TEST(Watch, AReturnIsOfItsAddressAndItsStackPointer) {
  Core core;
  core.call(1, kTask, 0x08000011);
  core.call(1, kTask - 64, 0x08000011);  // the same call, deeper: recursion
  core.now = 10;
  core.come_back(0x08000020, kTask);
  core.come_back(0x08000010, kTask - 32);
  EXPECT_TRUE(core.calls().empty());
  core.come_back(0x08000010, kTask - 64);
  EXPECT_EQ(core.calls(), (Calls{{1, 10}}));
  core.now = 15;
  core.come_back(0x08000010, kTask);
  EXPECT_EQ(core.calls(), (Calls{{1, 10}, {1, 15}}));
  core.call(1, kTask, 0x08000011);
  core.now = 20;
  core.call(1, kTask, 0x08000031);  // from another place
  core.now = 22;
  core.come_back(0x08000030, kTask);
  core.come_back(0x08000010, kTask);
  EXPECT_EQ(core.calls(), (Calls{{1, 10}, {1, 15}, {1, 2}, {1, 7}}));
}

// f calls g as its last act: both return to f's caller at once, the inner one first.
TEST(Watch, ATailCallReturnsWithItsCaller) {
  Core core;
  core.call(1, kTask, 0x08000011);
  core.now = 10;
  core.call(2, kTask, 0x08000011);
  core.now = 30;
  core.come_back(0x08000010, kTask);
  EXPECT_EQ(core.calls(), (Calls{{2, 20}, {1, 30}}));
}

TEST(Watch, OfTooManyOpenCallsTheOldestIsForgotten) {
  for (std::uint32_t deep : {64u, 65u}) {
    Core core;
    for (std::uint32_t i = 0; i < deep; ++i) core.call(1, kTask - 8 * i, 0x08000011 + 16 * i);
    for (std::uint32_t i = deep; i-- > 0;) core.come_back(0x08000010 + 16 * i, kTask - 8 * i);
    EXPECT_EQ(core.calls().size(), 64u) << deep;
  }
}

TEST(Watch, AResetEndsAllThatWasOpen) {
  Core core;
  core.call(1, kTask, 0x08000011);
  core.watch.line_changed(20, true, 0);
  core.enter(21, kTask);
  core.watch.core_was_reset();
  core.now = 50;
  core.come_back(0x08000010, kTask);  // by chance the same place again
  EXPECT_TRUE(core.calls().empty());
  EXPECT_EQ(core.watch.stacks().count(), 1u);
  core.call(2, kMain, 0x08000011);
  core.now = 60;
  core.enter(20, kMain);
  core.now = 80;
  core.leave_to_thread(20, kMain);
  core.come_back(0x08000010, kMain);
  EXPECT_EQ(core.calls(), (Calls{{2, 10}}));
  EXPECT_EQ(all_told(core).size(), 1u);  // and 20 was not requested since
}

TEST(Watch, AResetForgetsTheStacks) {
  Core core;
  core.call(1, kMain, 0x08000011);
  core.watch.stack_pointer_loads(core.thread(kMain), true);
  core.call(1, kTask, 0x08000011);
  ASSERT_EQ(core.watch.stacks().count(), 2u);
  core.watch.core_was_reset();
  core.call(1, kMain, 0x08000011);
  EXPECT_EQ(core.watch.stacks().count(), 1u);
}

TEST(Watch, ALoadOfTheStackPointerBeforeAResetIsForgotten) {
  Core core;
  core.watch.stack_pointer_loads(core.thread(kMain), true);
  core.watch.core_was_reset();
  core.call(1, kTask, 0x08000011);
  core.now = 20;
  core.come_back(0x08000010, kTask - 5000);  // no return, and the same stack for all that is known
  core.come_back(0x08000010, kTask);
  EXPECT_EQ(core.calls(), (Calls{{1, 20}}));
}

// Behind a handler the task goes on at its frame; that of the floating-point unit is larger. Both are
// aligned to eight bytes (Armv7-M B1.5.7).
TEST(Watch, ATaskThatGoesOnAtItsFrameIsTheSameTask) {
  struct Frame {
    std::uint32_t exc_return, sp, frame;
  };
  for (const Frame& f :
       {Frame{0xFFFFFFFD, kTask, kTask - 0x20}, Frame{0xFFFFFFED, kTask, kTask - 0x68},
        Frame{0xFFFFFFFD, kTask - 4, kTask - 0x28}, Frame{0xFFFFFFFD, kTask + 4, kTask - 0x20}}) {
    Core core;
    core.call(1, kOther, 0x08000011);
    core.watch.stack_pointer_loads(core.thread(kOther), true);
    core.call(2, f.sp, 0x08000021);  // a second task
    core.watch.exception(core.thread(f.sp), core.handler(15, f.exc_return));
    core.now = 10;
    core.leave_to_thread(15, kOther);
    core.now = 30;
    core.enter(15, kOther);
    core.now = 40;
    core.leave_to_thread(15, f.frame);
    EXPECT_EQ(core.watch.stacks().count(), 2u) << std::hex << f.exc_return;
    EXPECT_EQ(core.watch.stacks().current(), 1u) << std::hex << f.exc_return;
  }
}

}  // namespace
}  // namespace whirl::board
