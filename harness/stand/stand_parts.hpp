// One copy of a stand's hardware: draws what plant/parts/esc_stand.hpp lists and puts it where it belongs,
// into the power stage, the board's clocks and the bench's instruments.
//
//   Nominal  what the plan says, else the board's file, else the plant's own. What the plan states of a part
//            that has no nominal (stand.shunt's gain, offset) is that part's and is not drawn
//   Vehicle  an ESC board that turns a motor of a vehicle is such a copy, of the same table and streams: the ESC of motor 1
//            is that of a stand with this seed. What the vehicle's own table draws of each motor (plant/parts/vehicle.hpp)
//            it keeps from there; ambient is the place's, and a bench's instruments are not there
//   Order    draw_parts() on the stand's parameters, then set_parts() on the board that carries the ESC
#pragma once
#include <cstdint>

#include "harness/stand/stand_params.hpp"
#include "io_bridges/board_description/board_description.hpp"

namespace whirl::stand {

// Pre: params.tolerance names groups of the table only.
void draw_parts(StandParams& params, const BoardDescription& board, std::uint64_t seed);

Result<Done> set_parts(BoardDescription& board, const StandParams& params);

struct VehiclesEscParams {
  int motor = 1;  // of the vehicle, from 1: its draws are those of a stand with that motor
  plant::MotorParams shaft;  // this motor's, as the vehicle's copy has it
  plant::CurrentShuntParams shunt;
  plant::Tolerances
      tolerance;  // by a vehicle's groups: escs, motors (also phases, bridge, heat), clock
};

struct VehiclesEsc {
  StageParams stage;
  double hse_error = 0.0, hsi_error = 0.0;  // shares, beside what the board's file says
  std::vector<DrawnPart> drawn;             // "esc 2 divider.a.upper"
};

// stage: the motor of the board's power stage.
VehiclesEsc draw_esc(const VehiclesEscParams& params, const BoardDescription& board, int stage,
                     std::uint64_t seed);
// Errors   bad_input: the board has no such stage
Result<Done> set_esc(BoardDescription& board, int stage, const VehiclesEsc& esc);

}  // namespace whirl::stand
