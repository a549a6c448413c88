// Numbers as text, both ways, without printf and without double arithmetic.
//
//   Write   nine significant digits in scientific form ("1.00500002e-2"): enough to tell any two
//           floats apart
//   Parse   "3.25", "-1.2e-7": what people and programs write
//   Error   what write_number wrote, parse_number reads as the same bits (tests/text_number_test.cpp);
//           between the two a mantissa of 64 bits, good to 1e-16
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

namespace fw::esc {

// False: not a number, out of a float's range, or something follows. `value` is then untouched.
bool parse_number(std::string_view text, float& value);

using NumberText = std::array<char, 16>;
std::string_view write_number(float value, NumberText& text);  // a view of `text`; "nan", "inf"

}  // namespace fw::esc
