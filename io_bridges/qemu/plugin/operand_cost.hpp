// SPDX-License-Identifier: GPL-2.0-or-later
//
// What an instruction costs by its operands, which are known at run time only: steps of an early
// termination, counted without a branch. As 64-bit temporaries.
//
//   Divides    one step and another for each four bits of the quotient, none where it is 0: the divider
//              goes by the leading zeros that its operands do not share (DDI 0337: 2 to 12 cycles)
//   Multiplies a long one of the M3 takes 3 to 5, with accumulation 4 to 6, signed 5 to 7 (DDI 0337);
//              by the size of its operands: a step for each that does not fit 16 bits is our reading
#pragma once
#include "io_bridges/qemu/plugin/tcg.hpp"

namespace whirl::qemu {

tcg::Argument quotient_steps(tcg::Ahead& ahead, tcg::Argument dividend, tcg::Argument divisor,
                             bool with_sign);
tcg::Argument long_multiply_steps(tcg::Ahead& ahead, tcg::Argument a, tcg::Argument b,
                                  bool with_sign);

}  // namespace whirl::qemu
