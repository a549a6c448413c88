// The wires of a plan that join boards: is each end there, does nobody lead in a circle, and what does
// each board's target get of them.
#pragma once
#include <vector>

#include "base/result.hpp"
#include "harness/board/node.hpp"
#include "harness/cli/composition.hpp"
#include "harness/plan/plan_file.hpp"
#include "harness/target/node_set.hpp"

namespace whirl::cli {

// Errors  bad_input: a device that is not there, or on neither I2C nor SPI nor CAN nor a UART, or on another kind of bus than
//         the other end; one that two boards take the place of; a board that two others lead, a bus with two masters, a UART
//         with two wires, a board for two motors; two boards that share a CAN and more, a CAN with two arbiters; leads
//         that come back to where they began (each would wait for the other)
Result<Done> check_board_wires(const plan::Plan& plan, const std::vector<Node>& nodes);

// What each node says of its CAN buses that another board arbitrates. Pre: checked.
void note_joined(const plan::Plan& plan, std::vector<Node>& nodes);

// Makes the wires and gives each setup its ends, and that of the leader what its far boards are. The links have to
// outlive the targets' start. Pre: checked.
Result<std::vector<BoardWireLink>> join_boards(const plan::Plan& plan,
                                               const std::vector<Node>& nodes,
                                               std::vector<Setup>& setups);

}  // namespace whirl::cli
