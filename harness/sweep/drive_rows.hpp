// Rows of a motor on a bench, as data sheets and thrust stands print them.
//
//   In      text whose first line names its columns: V rpm A, and Nm, N (thrust), duty (0 to 1), prop (a
//           name; "none": nothing on the shaft) among them in any order; other columns are passed over
//   Where   V and A at the input of the ESC. No duty: full throttle, where input and motor see the same
//   Errors  bad_input with file and line
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl::sweep {

struct DriveRow {
  double bus_V = 0.0;  // 0 where the file has no such column; so with torque and thrust
  double speed_radps = 0.0;
  double bus_A = 0.0;
  double duty = 1.0;
  double torque_Nm = 0.0;
  double thrust_N = 0.0;
  std::string prop;
};
struct DriveFile {
  std::string name;
  bool volts = false, duty = false, torque = false, thrust = false, prop = false;
  std::vector<DriveRow> rows;
};
Result<DriveFile> read_drive_rows(const std::string& path);

inline constexpr const char* kNothing_on_the_shaft = "none";

}  // namespace whirl::sweep
