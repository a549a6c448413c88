// A person's game controller as the sticks and switches of a radio-control transmitter.
//
//   Travel   in steps of 0.1 %, so that what is recorded of it (recording.hpp) is what was flown
//   Before   its first report says where its sticks are: the switches off, thrust at its lower stop
//   Lost     pulled: the transmitter is off, and stays so
#pragma once
#include <memory>

#include "harness/live/stick_file.hpp"
#include "harness/world/request.hpp"

namespace whirl::live {

class PilotStick {
 public:
  // Errors  bad_input: the device has no such axis or button
  static Result<PilotStick> start(std::unique_ptr<io::HidPort> port, StickMap map);

  request::Sticks read();

 private:
  PilotStick(io::GameController controller, StickMap map)
      : controller_(std::move(controller)), map_(std::move(map)) {}
  bool pressed(const io::StickState& state, std::size_t button) const;

  io::GameController controller_;
  StickMap map_;
  bool arm_ = false, arm_pressed_ = false;
  int mode_ = 1;
};

}  // namespace whirl::live
