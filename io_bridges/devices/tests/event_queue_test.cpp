#include "io_bridges/devices/event_queue.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <memory>
#include <random>
#include <utility>
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

// Against a sorted list: what fires next, whatever actions set, move, cancel and ask meanwhile.
class RestlessEvents {
 public:
  RestlessEvents() {
    for (std::size_t i = 0; i < events_.size(); ++i) {
      events_[i] = std::make_unique<Event>(queue_, [this, i] { act(i); });
    }
  }
  void run() {
    while (acted_ < 5000) {
      if (expected_.empty()) set_all();
      queue_.run_until(queue_.now() + 7);
    }
  }

 private:
  using Key = std::pair<Nanoseconds, int>;  // due, as the how manieth it was set

  void set_all() {
    for (std::size_t i = 0; i < events_.size(); ++i) {
      set(i, queue_.now() + static_cast<Nanoseconds>(random_() % 50));
    }
  }
  void set(std::size_t i, Nanoseconds due) {
    events_[i]->at(due);
    drop(i);
    keys_[i] = {due, set_++};
    expected_[keys_[i]] = i;
  }
  void drop(std::size_t i) {
    expected_.erase(keys_[i]);
    keys_[i] = {};
  }
  void act(std::size_t i) {
    ++acted_;
    EXPECT_EQ(queue_.now(), keys_[i].first);
    EXPECT_EQ(expected_.begin()->second, i);
    drop(i);
    for (unsigned n = random_() % 5; n > 0; --n) {
      const std::size_t other = random_() % 3 == 0 ? i : random_() % events_.size();
      if (random_() % 4 == 0) {
        events_[other]->cancel();
        drop(other);
      } else {
        set(other, queue_.now() + static_cast<Nanoseconds>(random_() % 20));
      }
      EXPECT_EQ(events_[other]->pending(), keys_[other] != Key{});
    }
    if (random_() % 2 == 0) {
      EXPECT_EQ(queue_.next_deadline(),
                expected_.empty() ? kNever : expected_.begin()->first.first);
    }
  }

  EventQueue queue_;
  std::minstd_rand random_{1};
  std::array<std::unique_ptr<Event>, 40> events_;
  std::array<Key, 40> keys_{};
  std::map<Key, std::size_t> expected_;
  int set_ = 1, acted_ = 0;
};

TEST(EventQueue, ActionsThatSetMoveAndCancelOthersKeepTheOrder) {
  RestlessEvents().run();
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
