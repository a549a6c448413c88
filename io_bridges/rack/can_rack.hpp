// The devices of a board that hang on one of its CAN buses, without the board (far_rack.hpp).
//
//   Bus       its own, with arbitration and bit times (can_bus.hpp). The microcontroller is a node of it that
//             acknowledges and whose frames are given to it: each frame has taken its time here before it is heard
//             afar, and takes it again on copper
//   Faults    of the wire too (can_wire_faults.hpp): in the model of the bus, so that what they cost is time, or a frame that
//             is not heard afar; no error frame is on copper
//   Happened  every frame too (can_transfer)
#pragma once
#include <deque>
#include <functional>

#include "io_bridges/devices/can_wire_faults.hpp"
#include "io_bridges/rack/far_rack.hpp"

namespace whirl::rack {

class CanRack final : public FarRack {
 public:
  using FrameSink = std::function<void(const io::CanFrame&)>;
  // heard: what the microcontroller hears of the nodes, each with its last bit.
  CanRack(int bus, double rate_Hz, std::uint64_t seed, FrameSink heard);

  // A frame of the microcontroller's; those that wait go out in order.
  void give(const io::CanFrame& frame);

 private:
  class Afar final : public io::CanNode {
   public:
    Afar(io::CanBus& bus, double rate_Hz, FrameSink heard);
    void give(const io::CanFrame& frame);

   private:
    const io::CanFrame* offered() override {
      return waiting_.empty() ? nullptr : &waiting_.front();
    }
    void sent(Nanoseconds /*now*/) override { waiting_.pop_front(); }
    void receive(const io::CanFrame& frame, Nanoseconds /*now*/) override { heard_(frame); }
    void bus_off(Nanoseconds now) override;

    io::CanBus& bus_;
    io::CanStation& station_;
    FrameSink heard_;
    std::deque<io::CanFrame> waiting_;
  };

  bool carries(const BoardDevice& device) const override;
  io::CanBus* can(int number) override { return number == number_ ? &bus_ : nullptr; }

  int number_;
  io::CanBus bus_;
  io::CanWireFaults wire_faults_;
  Afar afar_;
};

}  // namespace whirl::rack
