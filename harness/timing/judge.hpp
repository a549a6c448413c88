// A report against its table: how far each kernel lies outside its range, and which is missing.
//
//   Error   0 inside the range, else the distance from its nearer end over that end, signed
//   Within  at most 10 % off; up to 15 % is told apart from worse, and is no pass either
//   Missing a kernel of the table that was not reported fails, and so does one that no table names
#pragma once
#include <string>
#include <vector>

#include "harness/timing/expectations.hpp"
#include "harness/timing/report.hpp"

namespace whirl::timing {

inline constexpr double kWithin = 0.10, kOuter = 0.15;

enum class Grade {
  within,
  outer,     // beyond 10 %, at most 15 %
  beyond,    // beyond 15 %
  missing,   // expected, not reported
  unknown,   // reported, in no table
  reported,  // no source gives a range
};

struct Verdict {
  Expectation expected;          // of an unknown kernel: its name only
  double measured_cycles = 0.0;  // per iteration; 0 where it is missing
  double error = 0.0;            // a share; 0 where nothing was judged
  Grade grade = Grade::missing;
};

struct Score {
  int within = 0, judged = 0;  // missing and unknown kernels are judged, and never within
  int outer = 0, missing = 0, unknown = 0;
  double mean_error = 0.0;  // of the magnitudes, over what was expected and reported
};

double error_of(double measured_cycles, const Expectation& expected);
// In the table's order, then what it does not know.
std::vector<Verdict> judge(const std::vector<Expectation>& table, const Report& report);
Score score_of(const std::vector<Verdict>& verdicts);
const char* name_of(Grade grade);

}  // namespace whirl::timing
