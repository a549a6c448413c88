// The stand's data as a text file, so that a fit can be looked at, and made again, without the stand.
//
//   Form     "#" comments; "radius 0.127"; one line per point: its list's name and its numbers in the
//            order of data.hpp; written with all digits, so that the same fit comes out
#pragma once
#include <string>

#include "base/result.hpp"
#include "harness/calibrate/data.hpp"

namespace whirl::calibrate {

std::string data_text(const StandData& data);
Result<StandData> read_data(const std::string& path);

}  // namespace whirl::calibrate
