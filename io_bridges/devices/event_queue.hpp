// Virtual time and what happens in it: one queue per board, exact nanoseconds, deterministic order.
//
//   Order    by time; of equal time by rank, then in the order in which they were set
//   Driver   QEMU's virtual clock in the board process, run_until() in tests
//   Progress a model whose events keep setting new ones at one instant is a bug: a failed check
//   Rule     an action runs with now() == its due time; it may set or cancel any event, itself too
#pragma once
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace whirl::io {

using Nanoseconds = std::int64_t;
inline constexpr Nanoseconds kNever = INT64_MAX;

class Event;

// Of events of one nanosecond: what comes over a wire from another board acts when the board's own
// models have; a bus that several may want decides when all have asked; a boundary ends what is done at its instant.
enum class Rank : std::uint8_t { own, wire, arbiter, boundary };

class EventQueue {
 public:
  // Where time comes from between events. Null: the queue's own time, moved by run_until().
  void set_clock(std::function<Nanoseconds()> clock) { clock_ = std::move(clock); }
  // Told whenever the earliest deadline changes outside of run_until().
  void set_rearm(std::function<void(Nanoseconds)> rearm) { rearm_ = std::move(rearm); }

  Nanoseconds now() const { return running_ || !clock_ ? now_ : clock_(); }
  Nanoseconds next_deadline() const;
  std::uint64_t fired() const { return fired_; }  // so far
  // Fires all that is due until t, then sets the time to t. Pre: t >= now().
  void run_until(Nanoseconds t);

 private:
  friend class Event;
  void insert(Event& event);
  void remove(Event& event);
  void fill_top();
  void sift_up(std::size_t i);
  void sift_down(std::size_t i);
  static bool before(const Event& a, const Event& b);
  static constexpr std::int64_t kMost_at_one_instant = 100'000;  // a busy board has some dozens

  std::vector<Event*> heap_;
  // While an action runs, until it sets an event: most set one that is due soon, which then takes the
  // place of the one that fired.
  bool top_is_free_ = false;
  std::function<Nanoseconds()> clock_;
  std::function<void(Nanoseconds)> rearm_;
  Nanoseconds now_ = 0;
  std::int64_t at_this_instant_ = 0;
  std::uint64_t sequence_ = 0, fired_ = 0;
  bool running_ = false;
};

// One thing that may happen. Lives inside its owner; leaving the scope cancels it.
class Event {
 public:
  Event(EventQueue& queue, std::function<void()> action, Rank rank = Rank::own)
      : queue_(queue), action_(std::move(action)), rank_(rank) {}
  ~Event() { cancel(); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;

  void at(Nanoseconds due);  // sets or moves; a due time in the past fires at once, at now()
  void in(Nanoseconds delay) { at(queue_.now() + delay); }
  void cancel();
  bool pending() const { return slot_ != kIdle; }
  Nanoseconds due() const { return due_; }

 private:
  friend class EventQueue;
  static constexpr std::size_t kIdle = SIZE_MAX;

  EventQueue& queue_;
  std::function<void()> action_;
  Nanoseconds due_ = kNever;
  std::uint64_t sequence_ = 0;
  Rank rank_;
  std::size_t slot_ = kIdle;
};

}  // namespace whirl::io
