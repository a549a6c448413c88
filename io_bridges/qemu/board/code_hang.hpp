// The fault code_hangs: functions that come no further than their first instruction.
//
//   Method   from the fault's start on the function's first halfword is "b .", at its end again what
//            the image has there; flash keeps it over a reset
//   Place    a watched function, by its number in the watch list (FaultCommand::address)
//   Applied  at the start; what names no function of the image is applied by nobody
#pragma once
#include <cstdint>
#include <deque>
#include <vector>

#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/messages/messages.hpp"
#include "io_bridges/qemu/board/emulator.hpp"
#include "io_bridges/qemu/board/image.hpp"

namespace whirl::board {

class CodeHangs {
 public:
  CodeHangs(io::EventQueue& events, Emulator& emulator, io::Batch& happened)
      : events_(events), emulator_(emulator), happened_(happened) {}

  void add(const io::FaultCommand& fault, const std::vector<const Symbol*>& functions);

 private:
  struct Hang {
    Hang(CodeHangs& owner, std::uint32_t number, std::uint32_t address);

    std::uint16_t code = 0;  // of the image
    io::Event begin, end;
  };

  io::EventQueue& events_;
  Emulator& emulator_;
  io::Batch& happened_;
  std::deque<Hang> hangs_;  // events must stay where they are
};

}  // namespace whirl::board
