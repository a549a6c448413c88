// SPDX-License-Identifier: GPL-2.0-or-later
#include "io_bridges/qemu/plugin/operand_cost.hpp"

namespace whirl::qemu {

using tcg::Ahead;
using tcg::Argument;
using tcg::number32;

namespace {

// The bits that tell a number's size: a negative one's are those that differ from its sign.
Argument magnitude(Ahead& ahead, Argument x, bool with_sign) {
  const tcg::Numbers& op = tcg::numbers();
  return with_sign ? ahead.op32(op.xor32, x, ahead.op32(op.sar32, x, number32(31))) : x;
}

}  // namespace

Argument quotient_steps(Ahead& ahead, Argument dividend, Argument divisor, bool with_sign) {
  const tcg::Numbers& op = tcg::numbers();
  const auto zeros = [&](Argument x) {
    return ahead.op32(op.leading_zeros32, magnitude(ahead, x, with_sign), number32(32));
  };
  const Argument bits = ahead.op32(op.sub32, zeros(divisor), zeros(dividend));
  const Argument none = ahead.op32(op.sar32, bits, number32(31));
  const Argument steps = ahead.op32(op.add32, ahead.op32(op.sar32, bits, number32(2)), number32(1));
  const Argument some = ahead.op32(op.sub32, number32(-1), none);
  return ahead.op64(op.widen, ahead.op32(op.and32, steps, some));
}

Argument long_multiply_steps(Ahead& ahead, Argument a, Argument b, bool with_sign) {
  const tcg::Numbers& op = tcg::numbers();
  const auto large = [&](Argument x) {  // the sign of what is below 0 where the upper part is not
    const Argument upper =
        ahead.op32(op.shr32, magnitude(ahead, x, with_sign), number32(with_sign ? 15 : 16));
    return ahead.op32(op.shr32, ahead.op32(op.sub32, number32(0), upper), number32(31));
  };
  return ahead.op64(op.widen, ahead.op32(op.add32, large(a), large(b)));
}

}  // namespace whirl::qemu
