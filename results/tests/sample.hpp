// A report with an expectation that passed and one that could not be measured.
#pragma once
#include <cmath>

#include "results/report.hpp"

namespace whirl::results {

inline Report sample() {
  Report r;
  r.plan = "hover <1> & \"quoted\"";
  r.file = "hover.lua";
  r.seed = 7;
  r.digest = "0123456789abcdef";
  r.virtual_s = 10.0;
  Expectation good;
  good.name = "height";
  good.verdict = Verdict::pass;
  good.how = "at most";
  good.measured = 3.0;
  good.high = 5.0;
  good.unit = "cm";
  good.margin = 2.0;
  Expectation bad = good;
  bad.name = "tilt \x01";
  bad.verdict = Verdict::fail;
  bad.measured = std::nan("");
  bad.note = "nothing to measure";
  r.expectations = {good, bad};
  conclude(r);
  return r;
}

}  // namespace whirl::results
