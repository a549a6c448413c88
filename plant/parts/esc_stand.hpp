// What the parts of an ESC on its thrust stand are from copy to copy: a table, one line for each number.
//
//   Names    those of the power stage's keys, `shunt.offset`; of the board's, `hse_error`; of the stand's
//            instruments, `cell.thrust_gain`
//   Units    SI; `of_nominal`: shares by which the board's or the plan's own number is off
//   Groups   what a stand's `tolerance` may choose one by one
//   Source   on each line; [F103] is ST DS5319, tables 49 and 50 (converter) and 24 (HSI); `estimate` is
//            what no maker states, and from what it is taken
//   Left out dead time and ringing (the stage has neither), lead inductance, the ESC's own heat
#pragma once
#include <span>

#include "plant/parts/part_number.hpp"

namespace whirl::plant {

std::span<const PartNumber> esc_stand_numbers();
std::span<const char* const> esc_stand_groups();

// Of its drawing, from a phase or the bus to the converter's pin: 1.5 kohm below 10.
inline constexpr double kVoltageDivider = 1.5 / 11.5;
// A divider of two resistors: by which share its ratio is off when they are, by these.
double divider_error(double upper_error, double lower_error);

}  // namespace whirl::plant
