#include "io_bridges/devices/event_queue.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "base/check.hpp"

namespace whirl::io {
namespace {

TEST(EventQueue, FiresInOrderOfTimeThenOfSetting) {
  EventQueue queue;
  std::vector<int> order;
  Event late(queue, [&] { order.push_back(3); });
  Event first(queue, [&] { order.push_back(1); });
  Event second(queue, [&] { order.push_back(2); });
  late.at(20);
  first.at(10);
  second.at(10);
  queue.run_until(100);
  EXPECT_EQ(order, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(queue.now(), 100);
}

TEST(EventQueue, AnActionSeesItsOwnDueTimeAndMaySetItselfAgain) {
  EventQueue queue;
  std::vector<Nanoseconds> times;
  Event* self = nullptr;
  Event tick(queue, [&] {
    times.push_back(queue.now());
    if (times.size() < 3) self->in(7);
  });
  self = &tick;
  tick.at(5);
  queue.run_until(50);
  EXPECT_EQ(times, (std::vector<Nanoseconds>{5, 12, 19}));
}

TEST(EventQueue, CancelledAndMovedEventsDoNotFireAtTheirOldTime) {
  EventQueue queue;
  int fired = 0;
  Event moved(queue, [&] { ++fired; });
  Event gone(queue, [&] { fired += 100; });
  moved.at(10);
  gone.at(10);
  gone.cancel();
  moved.at(30);
  queue.run_until(29);
  EXPECT_EQ(fired, 0);
  queue.run_until(30);
  EXPECT_EQ(fired, 1);
}

TEST(EventQueue, KeepsTimeOrderUnderRandomSettingAndCancelling) {
  EventQueue queue;
  std::vector<std::unique_ptr<Event>> events;
  Nanoseconds last = -1;
  int fired = 0;
  for (int i = 0; i < 500; ++i) {
    events.push_back(std::make_unique<Event>(queue, [&] {
      EXPECT_GE(queue.now(), last);
      last = queue.now();
      ++fired;
    }));
    events.back()->at((i * 7919) % 1009);
  }
  for (int i = 0; i < 500; i += 5) events[static_cast<std::size_t>(i)]->cancel();
  queue.run_until(2000);
  EXPECT_EQ(fired, 400);
}

TEST(EventQueue, EventsForEverAtOneInstantFailACheckInsteadOfHanging) {
  whirl::base::set_check_handler(whirl::base::throw_check_failure);
  EventQueue queue;
  int left = 1000;
  std::unique_ptr<Event> patient, restless;
  patient = std::make_unique<Event>(queue, [&] {
    if (--left > 0) patient->in(0);
  });
  patient->at(5);
  queue.run_until(10);  // a thousand at one instant are many, but not for ever
  EXPECT_EQ(left, 0);
  restless = std::make_unique<Event>(queue, [&] { restless->in(0); });
  restless->at(20);
  EXPECT_THROW(queue.run_until(30), whirl::base::CheckFailed);
  whirl::base::set_check_handler(nullptr);
}

}  // namespace
}  // namespace whirl::io
