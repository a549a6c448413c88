// One copy of a stand's hardware: draws what plant/parts/esc_stand.hpp lists and puts it where it belongs,
// into the power stage, the board's clocks and the bench's instruments.
//
//   Nominal  what the plan says, else the board's file, else the plant's own. What the plan states of a part
//            that has no nominal (stand.shunt's gain, offset) is that part's and is not drawn
//   Order    draw_parts() on the stand's parameters, then set_parts() on the board that carries the ESC
#pragma once
#include <cstdint>

#include "harness/stand/stand_params.hpp"
#include "io_bridges/board_description/board_description.hpp"

namespace whirl::stand {

// Pre: params.tolerance names groups of the table only.
void draw_parts(StandParams& params, const BoardDescription& board, std::uint64_t seed);

Result<Done> set_parts(BoardDescription& board, const StandParams& params);

}  // namespace whirl::stand
