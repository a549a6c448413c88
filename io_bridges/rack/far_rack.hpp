// Devices of a board without the board: a host plays them to a microcontroller that is elsewhere, of metal or in another
// process, over the one wire that they hang on.
//
//   Time      of the caller: events().run_until(); messages, and what comes from afar, act at its now
//   Happened  what devices tell, as on a virtual board
//   Faults    of its devices, by their numbers on the board; those of a wire are the class's that has it
//   Errors    bad_input: a device needs more of the board than its wire, or takes what another one takes
#pragma once
#include <memory>
#include <vector>

#include "io_bridges/rack/device_type.hpp"
#include "io_bridges/rack/takers.hpp"

namespace whirl::rack {

class FarRack : protected Rack {
 public:
  explicit FarRack(std::uint64_t seed);

  // Of `board` the devices on its wire. Pre: once.
  Result<Done> build(const BoardDescription& board, const DeviceTypes& types);
  std::size_t devices() const { return devices_.size(); }
  // A message from the harness, to all that take it.
  void on_message(const io::Reader& message);
  io::EventQueue& events() override { return events_; }
  const io::EventQueue& events() const { return events_; }
  io::Batch& happened() override { return happened_; }

 protected:
  io::FindingSink finding() override;
  io::FaultBook& faults() override { return faults_; }

 private:
  virtual bool carries(const BoardDevice& device) const = 0;
  Result<Done> add(const BoardDescription& board, int number, const DeviceTypes& types);

  std::uint64_t seed() const override { return seed_; }
  std::string file_to_leave(const std::string& /*device*/) const override { return ""; }
  io::Wire* pin(const std::string& /*name*/) override { return nullptr; }
  bool set_analog(const std::string&, std::function<double(Nanoseconds)>) override { return false; }
  io::I2cBus* i2c(int /*number*/) override { return nullptr; }
  io::CanBus* can(int /*number*/) override { return nullptr; }
  bool join_spi(int, io::Wire&, io::SpiTarget&, const BoardDevice&, int) override { return false; }
  bool join_uart(int, io::UartPeer&) override { return false; }

  std::uint64_t seed_;
  io::EventQueue events_;
  io::FaultBook faults_;
  io::Batch happened_;
  std::vector<std::unique_ptr<RackDevice>> devices_;
  Takers takers_;
};

}  // namespace whirl::rack
