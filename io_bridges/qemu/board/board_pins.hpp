// What a board has on pins beside devices: names, resistors, the lines of a bus.
//
//   Out     the I2C buses whose two lines are soldered to named pins
//   Errors  bad_input: a pin that the part does not have, half a bus, an unknown pull
#pragma once
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/board_description/board_description.hpp"
#include "io_bridges/messages/messages.hpp"
#include "io_bridges/qemu/stm32/chip_model.hpp"

namespace whirl::board {

Result<std::set<int>> join_pins(const std::vector<BoardPin>& pins, stm32::ChipModel& chip,
                                const std::string& board);

// The level of a named pin at the start, and each change of it, becomes a pin_edge; those of a bus's
// lines do not, they are in its transactions.
void log_edges(const std::vector<BoardPin>& pins, stm32::ChipModel& chip, io::Batch& happened);

// The first address that firmware asks for on an I2C bus with no device at all is a finding: its bytes
// are NACKed one and all, and leave no other trace.
void watch_empty_buses(const std::function<bool(int bus)>& used, stm32::ChipModel& chip,
                       const io::FindingSink& finding);

}  // namespace whirl::board
