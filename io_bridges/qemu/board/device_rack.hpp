// The devices of a board: built from its description by their types (io_bridges/rack), hung on the
// chip's pins and buses, joined to the messages of the link.
//
//   Logs      every frame on CAN; every I2C transaction; every SPI transaction with its first 16 pairs of bytes (MOSI,
//             MISO); each with the times of its bytes. The edges of the pins that the board names
//   Messages  go to the devices that take their kind and port; faults into the book that all share
//   Findings  two that drive one pin or a line of an I2C bus against each other, and two devices selected at once on one SPI
//             bus (once for each two), a pin of the board file that nothing ever drove (at the end)
//   Files     of memory parts: NAME.img in the run's folder, NAME_NODE.img of a board with a name
//   Far       a device that a wire names is on another board: what stands here only listens to what that one is sent
//   Errors    bad_input: what check_board.hpp refuses, a bus or pin that the part does not have
#pragma once
#include <memory>
#include <string>

#include "base/result.hpp"
#include "io_bridges/board_description/board_description.hpp"
#include "io_bridges/messages/messages.hpp"
#include "io_bridges/qemu/board/wire_ends.hpp"
#include "io_bridges/qemu/stm32/chip_model.hpp"
#include "io_bridges/rack/device_type.hpp"

namespace whirl::board {

class DeviceRack {
 public:
  struct Site {
    io::EventQueue& events;
    stm32::ChipModel& chip;
    io::Batch& happened;
    io::FindingSink finding;
    std::uint64_t seed;
    const rack::DeviceTypes& types;
    std::string folder = {}, node = {};  // BoardRun
    WireEnds* wires = nullptr;           // to other boards
    std::vector<WireEnd> ends = {};      // of those that a device's place is led to
  };

  explicit DeviceRack(Site site);
  ~DeviceRack();

  Result<Done> build(const BoardDescription& board);
  // A message from the harness; false: no device takes it.
  bool on_message(const io::Reader& message);
  // At a boundary, before what happened is posted: what devices tell at each one.
  void report(io::Nanoseconds now);
  void run_ends(io::Nanoseconds now);
  // A bus on which another board is the master.
  Result<Done> follow(const WireEnd& end);

 private:
  class Wiring;
  std::unique_ptr<Wiring> wiring_;
};

}  // namespace whirl::board
