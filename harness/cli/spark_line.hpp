// A row of a live view: the last values of a signal as a line of blocks, eight heights.
#pragma once
#include <span>
#include <string>

namespace whirl::cli {

// One block per value, from the lowest to the highest of them; a dot where there is none (NaN), the middle block where
// all are equal.
std::string spark_line(std::span<const double> values);

}  // namespace whirl::cli
