// The rows of the table, as lines of text on the serial line.
//
//   First   "timing 1 PART"
//   Rows    "row NAME ITERATIONS CYCLES": cycles of all iterations together, decimal; each row goes out as it
//           is measured, with nothing measured meanwhile, so that a fault tells by what is missing
//   Last    "end ROWS"
#pragma once
#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace fw::timing {

void begin_report();
// The name is put together from `parts`.
void report(std::initializer_list<std::string_view> parts, std::uint32_t iterations,
            std::uint32_t cycles);
void end_report();

// Decimal digits of a number, without a heap.
class Digits {
 public:
  explicit Digits(std::uint32_t value);
  operator std::string_view() const { return {text_ + at_, sizeof text_ - at_}; }

 private:
  char text_[10];
  std::uint32_t at_ = sizeof text_;
};

}  // namespace fw::timing
