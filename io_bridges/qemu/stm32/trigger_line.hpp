// A line inside the chip: TRGO of a timer, a compare output on its way to an ADC, an EXTI line.
//
//   A source computes its edges only while somebody listens (a timer that nobody hears costs no
//   event), so listening is part of the line: whoever selects it says so, and says when it stops.
#pragma once
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "io_bridges/devices/event_queue.hpp"

namespace whirl::stm32 {

using io::Nanoseconds;

class TriggerLine {
 public:
  using Sink = std::function<void(bool level, Nanoseconds now)>;

  TriggerLine() = default;
  TriggerLine(const TriggerLine&) = delete;
  TriggerLine& operator=(const TriggerLine&) = delete;

  // The listener's side: a sink hears nothing before listen(handle, true).
  int add_sink(Sink sink) {
    sinks_.push_back({std::move(sink), false});
    return static_cast<int>(sinks_.size()) - 1;
  }
  void listen(int handle, bool on) {
    Entry& entry = sinks_[static_cast<std::size_t>(handle)];
    if (entry.listening == on) return;
    entry.listening = on;
    listeners_ += on ? 1 : -1;
    if (wanted_changed_) wanted_changed_();
  }
  bool level() const { return level_; }

  // The source's side.
  bool wanted() const { return listeners_ > 0; }
  void on_wanted_change(std::function<void()> changed) { wanted_changed_ = std::move(changed); }
  void set(bool level, Nanoseconds now) {
    if (level == level_) return;
    level_ = level;
    notify(level, now);
  }
  void pulse(Nanoseconds now) {
    set(true, now);
    set(false, now);
  }

 private:
  struct Entry {
    Sink sink;
    bool listening;
  };
  void notify(bool level, Nanoseconds now) {
    for (std::size_t i = 0; i < sinks_.size(); ++i) {
      if (sinks_[i].listening) sinks_[i].sink(level, now);
    }
  }

  std::vector<Entry> sinks_;
  std::function<void()> wanted_changed_;
  int listeners_ = 0;
  bool level_ = false;
};

}  // namespace whirl::stm32
