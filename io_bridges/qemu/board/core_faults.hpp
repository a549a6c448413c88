// The faults of a board that strike its core: a function that comes no further, NRST, and a board that is
// pulled out of its sockets and put back.
//
//   Unplugged  from its start on the part is in reset, so its pins float and no peripheral of it drives or answers
//              anything: what a board without supply shows on its wires. At its end RAM and backup registers have
//              lost what they held, and it starts as from power-up
//   Method     the part is reset and its core held in a WFI at the reset vector's first instruction, with no
//              interrupt enabled; at the end flash has the image's own again
//   Left out   the devices on the board keep what they were set to; a power stage keeps its motor and its supply,
//              with all switches off
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <functional>

#include "io_bridges/qemu/board/code_hang.hpp"

namespace whirl::board {

class CoreFaults {
 public:
  struct Site {
    io::EventQueue& events;
    Emulator& emulator;
    io::Batch& happened;
    const Image& image;
    const std::vector<std::string>& watch;  // names, by their numbers
    std::uint32_t vectors;                  // address of those that the core starts from
    std::function<void(double volts)> set_vdd;
  };
  explicit CoreFaults(const Site& site)
      : site_(site), hangs_(site.events, site.emulator, site.happened) {}

  bool on_fault(const io::FaultCommand& fault);  // false: none of these

 private:
  void hang(const io::FaultCommand& fault);
  void pull_reset_pin(const io::FaultCommand& fault);
  void unplug(const io::FaultCommand& fault);
  void supply_gone();
  void supply_back();
  void applied(std::uint32_t number);
  std::uint32_t first_instruction() const;

  Site site_;
  CodeHangs hangs_;
  std::deque<io::Event> due_;            // events must stay where they are
  int unplugged_ = 0;                    // by so many faults
  std::array<std::uint16_t, 2> code_{};  // of the image, where the core is held
};

}  // namespace whirl::board
