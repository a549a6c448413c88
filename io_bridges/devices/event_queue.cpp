#include "io_bridges/devices/event_queue.hpp"

#include <algorithm>

#include "base/check.hpp"

namespace whirl::io {

bool EventQueue::before(const Event& a, const Event& b) {
  if (a.due_ != b.due_) return a.due_ < b.due_;
  return a.rank_ != b.rank_ ? a.rank_ < b.rank_ : a.sequence_ < b.sequence_;
}

Nanoseconds EventQueue::next_deadline() const {
  if (!top_is_free_) return heap_.empty() ? kNever : heap_.front()->due_;
  // An action asks, which few do: the next of all is one of the two below the top, if any.
  Nanoseconds next = kNever;
  for (std::size_t i = 1; i < std::min<std::size_t>(3, heap_.size()); ++i) {
    next = std::min(next, heap_[i]->due_);
  }
  return next;
}

void EventQueue::sift_up(std::size_t i) {
  Event* moving = heap_[i];
  for (; i > 0; i = (i - 1) / 2) {
    Event* parent = heap_[(i - 1) / 2];
    if (!before(*moving, *parent)) break;
    heap_[i] = parent;
    parent->slot_ = i;
  }
  heap_[i] = moving;
  moving->slot_ = i;
}

void EventQueue::sift_down(std::size_t i) {
  Event* moving = heap_[i];
  for (std::size_t child = 2 * i + 1; child < heap_.size(); child = 2 * i + 1) {
    if (child + 1 < heap_.size() && before(*heap_[child + 1], *heap_[child])) ++child;
    if (!before(*heap_[child], *moving)) break;
    heap_[i] = heap_[child];
    heap_[i]->slot_ = i;
    i = child;
  }
  heap_[i] = moving;
  moving->slot_ = i;
}

void EventQueue::insert(Event& event) {
  event.sequence_ = sequence_++;
  if (top_is_free_) {
    top_is_free_ = false;
    heap_.front() = &event;
    return sift_down(0);
  }
  heap_.push_back(&event);
  sift_up(heap_.size() - 1);
}

void EventQueue::remove(Event& event) {
  fill_top();
  const std::size_t hole = event.slot_;
  event.slot_ = Event::kIdle;
  Event* last = heap_.back();
  heap_.pop_back();
  if (last == &event) return;
  heap_[hole] = last;
  last->slot_ = hole;
  sift_up(hole);
  sift_down(last->slot_);
}

void EventQueue::fill_top() {
  if (!top_is_free_) return;
  top_is_free_ = false;
  Event* last = heap_.back();
  heap_.pop_back();
  if (heap_.empty()) return;
  heap_.front() = last;
  sift_down(0);
}

void EventQueue::run_until(Nanoseconds t) {
  WHIRL_CHECK(!running_);
  WHIRL_CHECK(t >= now_, t, now_);
  running_ = true;
  while (!heap_.empty() && heap_.front()->due_ <= t) {
    Event& event = *heap_.front();
    at_this_instant_ = event.due_ > now_ ? 0 : at_this_instant_ + 1;
    WHIRL_CHECK(at_this_instant_ < kMost_at_one_instant, now_);
    now_ = std::max(now_, event.due_);
    event.slot_ = Event::kIdle;
    top_is_free_ = true;
    ++fired_;
    event.action_();
    fill_top();
  }
  now_ = t;
  running_ = false;
}

void Event::at(Nanoseconds due) {
  if (queue_.running_) {
    if (pending()) queue_.remove(*this);
    due_ = std::max(due, queue_.now_);
    return queue_.insert(*this);
  }
  const Nanoseconds earliest = queue_.next_deadline();
  if (pending()) queue_.remove(*this);
  due_ = std::max(due, queue_.now());
  queue_.insert(*this);
  if (queue_.rearm_ && queue_.next_deadline() != earliest) {
    queue_.rearm_(queue_.next_deadline());
  }
}

void Event::cancel() {
  if (pending()) queue_.remove(*this);  // a timer that fires for nothing is harmless: no rearm
}

}  // namespace whirl::io
