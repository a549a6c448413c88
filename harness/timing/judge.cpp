#include "harness/timing/judge.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::timing {
namespace {

Grade grade_of(double error) {
  const double size = std::abs(error);
  if (size <= kWithin) return Grade::within;
  return size <= kOuter ? Grade::outer : Grade::beyond;
}

Verdict judged(const Expectation& expected, const Report& report) {
  Verdict verdict{expected, 0.0, 0.0, Grade::missing};
  const auto row = std::find_if(report.rows.begin(), report.rows.end(),
                                [&](const Row& r) { return r.kernel == expected.kernel; });
  if (row == report.rows.end()) return verdict;
  verdict.measured_cycles = row->cycles_per_iteration();
  verdict.grade = Grade::reported;
  if (!expected.judged) return verdict;
  verdict.error = error_of(verdict.measured_cycles, expected);
  verdict.grade = grade_of(verdict.error);
  return verdict;
}

}  // namespace

double error_of(double measured_cycles, const Expectation& expected) {
  const double nearest = std::clamp(measured_cycles, expected.low_cycles, expected.high_cycles);
  return (measured_cycles - nearest) / nearest;
}

std::vector<Verdict> judge(const std::vector<Expectation>& table, const Report& report) {
  std::vector<Verdict> verdicts;
  verdicts.reserve(table.size());
  for (const Expectation& expected : table) verdicts.push_back(judged(expected, report));
  for (const Row& row : report.rows) {
    const bool known = std::any_of(table.begin(), table.end(),
                                   [&](const Expectation& e) { return e.kernel == row.kernel; });
    if (known) continue;
    Verdict verdict;
    verdict.expected.kernel = row.kernel;
    verdict.measured_cycles = row.cycles_per_iteration();
    verdict.grade = Grade::unknown;
    verdicts.push_back(std::move(verdict));
  }
  return verdicts;
}

Score score_of(const std::vector<Verdict>& verdicts) {
  Score score;
  int measured = 0;
  for (const Verdict& verdict : verdicts) {
    if (verdict.grade == Grade::reported) continue;
    ++score.judged;
    score.within += verdict.grade == Grade::within ? 1 : 0;
    score.outer += verdict.grade == Grade::outer ? 1 : 0;
    score.missing += verdict.grade == Grade::missing ? 1 : 0;
    score.unknown += verdict.grade == Grade::unknown ? 1 : 0;
    if (verdict.grade == Grade::missing || verdict.grade == Grade::unknown) continue;
    ++measured;
    score.mean_error += std::abs(verdict.error);
  }
  if (measured > 0) score.mean_error /= measured;
  return score;
}

const char* name_of(Grade grade) {
  switch (grade) {
    case Grade::within:
      return "within";
    case Grade::outer:
      return "within 15 %";
    case Grade::beyond:
      return "OFF";
    case Grade::missing:
      return "NOT REPORTED";
    case Grade::unknown:
      return "NOT IN THE TABLE";
    case Grade::reported:
      return "not judged";
  }
  return "";
}

}  // namespace whirl::timing
