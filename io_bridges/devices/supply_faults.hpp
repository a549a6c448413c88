// The supply of a part as faults take it away: memory_removed and sensor_brown_out from start to end,
// memory_cut from the middle of the first write that begins while it is in force.
//
//   Use    the part asks write_begins() at each write; `off` and `on` are called at their instants
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "io_bridges/devices/faults.hpp"

namespace whirl::io {

class SupplyFaults {
 public:
  using Action = std::function<void(Nanoseconds)>;

  // `book` may be null. `off` may come twice; `on` comes after it.
  SupplyFaults(EventQueue& queue, FaultBook* book, int bus, int device, Action off, Action on);

  void write_begins(Nanoseconds now, Nanoseconds write_ns);

 private:
  void watch(const Fault& added);
  void at(Nanoseconds when, std::function<void()> action);
  void supply_may_return();
  void lose(Nanoseconds now);

  EventQueue& queue_;
  FaultBook* book_;
  int bus_, device_;
  bool lost_ = false;
  Action off_, on_;
  Event cut_;
  std::vector<std::unique_ptr<Event>> edges_;
};

}  // namespace whirl::io
