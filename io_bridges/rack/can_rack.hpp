// The devices of a board that hang on one of its CAN buses, without the board: a host plays them to a microcontroller
// that is elsewhere, of metal or in another process.
//
//   Time      of the caller: events().run_until(); messages, and frames from afar, act at its now
//   Bus       its own, with arbitration and bit times (can_bus.hpp). The microcontroller is a node of it that
//             acknowledges and whose frames are given to it: each frame has taken its time here before it is heard
//             afar, and takes it again on copper
//   Happened  what devices tell, and every frame (can_transfer), as on a virtual board
//   Errors    bad_input: a device of the bus needs more of the board than its bus
//   Left out  faults of the wire
#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "io_bridges/rack/device_type.hpp"

namespace whirl::rack {

class CanRack final : private Rack {
 public:
  using FrameSink = std::function<void(const io::CanFrame&)>;
  // heard: what the microcontroller hears of the nodes, each with its last bit.
  CanRack(int bus, double rate_Hz, std::uint64_t seed, FrameSink heard);

  // Of `board` the devices on its bus. Pre: once.
  Result<Done> build(const BoardDescription& board, const DeviceTypes& types);
  std::size_t devices() const { return devices_.size(); }
  // A message from the harness, to all that take it.
  void on_message(const io::Reader& message);
  // A frame of the microcontroller's; those that wait go out in order.
  void give(const io::CanFrame& frame);
  io::EventQueue& events() override { return events_; }
  const io::EventQueue& events() const { return events_; }
  io::Batch& happened() override { return happened_; }

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

  Result<Done> add(const BoardDescription& board, int number, const DeviceTypes& types);

  io::FaultBook& faults() override { return faults_; }
  io::FindingSink finding() override;
  std::uint64_t seed() const override { return seed_; }
  std::string file_to_leave(const std::string& /*device*/) const override { return ""; }
  io::Wire* pin(const std::string& /*name*/) override { return nullptr; }
  bool set_analog(const std::string&, std::function<double(Nanoseconds)>) override { return false; }
  io::I2cBus* i2c(int /*number*/) override { return nullptr; }
  io::CanBus* can(int number) override { return number == number_ ? &bus_ : nullptr; }
  bool join_spi(int, io::Wire&, io::SpiTarget&, const BoardDevice&, int) override { return false; }
  bool join_uart(int, io::UartPeer&) override { return false; }

  int number_;
  std::uint64_t seed_;
  io::EventQueue events_;
  io::FaultBook faults_;
  io::Batch happened_;
  io::CanBus bus_;
  Afar afar_;
  std::vector<std::unique_ptr<RackDevice>> devices_;
};

}  // namespace whirl::rack
