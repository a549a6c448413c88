// The faults of a CAN bus: what a FaultBook asks for, done to its wire. (See FaultKind for each.)
//
//   can_cut   of a device: its stub is open. Of the bus: the microcontroller is alone on it
//   can_babble  a node of its own, at the bit rate of the microcontroller, that acknowledges as well
#pragma once
#include <map>
#include <memory>
#include <vector>

#include "io_bridges/devices/can_bus.hpp"
#include "io_bridges/devices/faults.hpp"

namespace whirl::io {

class CanWireFaults : public CanFaults, private CanNode {
 public:
  // Joins the bus as its faults. `number` is the bus's number in Fault::bus (CAN2: 2); bit_ns of the
  // babbling node.
  CanWireFaults(EventQueue& queue, FaultBook& book, CanBus& bus, int number, double bit_ns);

  bool cut(int number, Nanoseconds now) override;
  bool acknowledged(int sender, Nanoseconds now) override;
  bool spoiled(int sender, Nanoseconds now) override;
  bool lost(int receiver, Nanoseconds now) override;
  Nanoseconds held(int sender, Nanoseconds now) override;

 private:
  const CanFrame* offered() override;
  void sent(Nanoseconds now) override;
  void receive(const CanFrame& /*frame*/, Nanoseconds /*now*/) override {}
  void joined(Nanoseconds /*now*/) override { bus_.request(babbler_); }

  const Fault* find(FaultKind kind, int number, Nanoseconds now) const;
  void schedule(const Fault& fault);
  void at(Nanoseconds t, std::function<void()> action);

  EventQueue& queue_;
  FaultBook& book_;
  CanBus& bus_;
  int number_;
  double bit_ns_;
  CanStation& babbler_;
  CanFrame babble_;
  double share_ = 1.0;
  Nanoseconds silent_until_ns_ = 0, began_ns_ = 0;
  Event again_;
  std::map<std::uint32_t, int> frames_;  // seen by each fault that waits for its n-th
  std::vector<std::unique_ptr<Event>> events_;
};

}  // namespace whirl::io
