// Measured points of a propeller, as they are published.
//
//   In      text whose first line names its columns: J, CT, CP and rpm among them in any order; other columns
//           are passed over, no J means at rest. Without an rpm column the speed is the number after the
//           last '_' of the file's name, as in the UIUC database.
//   Errors  bad_input with file and line
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"
#include "plant/rotor/blade_fit.hpp"

namespace whirl::sweep {

struct MeasuredFile {
  std::string name;
  std::vector<plant::MeasuredPoint> points;
};
Result<MeasuredFile> read_measured(const std::string& path);

}  // namespace whirl::sweep
