#include "results/report.hpp"

#include <array>
#include <cstdio>

namespace whirl::results {
namespace {

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

}  // namespace

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "fail";
    case Verdict::inconclusive:
      return "inconclusive";
    case Verdict::error:
      return "error";
  }
  return "?";
}

std::string Expectation::limit_text() const {
  const std::string tail = unit.empty() ? "" : " " + unit;
  if (low && high) return how + " " + number(*low) + " .. " + number(*high) + tail;
  if (high) return how + " " + number(*high) + tail;
  if (low) return how + " " + number(*low) + tail;
  return how;
}

void conclude(Report& report) {
  if (!report.reason.empty()) return;
  std::size_t failed = 0;
  const Expectation* first = nullptr;
  for (const Expectation& e : report.expectations) {
    if (e.verdict == Verdict::pass) continue;
    ++failed;
    if (first == nullptr) first = &e;
  }
  if (report.expectations.empty()) {
    report.verdict = Verdict::error;
    report.bad_input = true;
    report.reason = report.file + ": the plan expects nothing, so it could not fail";
  } else if (first == nullptr) {
    report.verdict = Verdict::pass;
  } else {
    report.verdict = Verdict::fail;
    report.reason = first->name + ": " + number(first->measured) +
                    (first->unit.empty() ? "" : " " + first->unit) + ", wanted " +
                    first->limit_text();
    if (failed > 1) report.reason += " (and " + std::to_string(failed - 1) + " more)";
  }
}

int exit_code(const Report& report) {
  switch (report.verdict) {
    case Verdict::pass:
      return 0;
    case Verdict::fail:
      return 1;
    case Verdict::inconclusive:
      return 3;
    case Verdict::error:
      return report.bad_input ? 2 : 4;
  }
  return 4;
}

int worse_exit_code(int a, int b) {
  constexpr std::array kRank{0, 2, 3, 1,
                             4};  // by code: pass, failed, bad input, inconclusive, internal
  const auto known = [](int code) { return code >= 0 && code <= 4 ? code : 4; };
  a = known(a);
  b = known(b);
  return kRank[static_cast<std::size_t>(a)] >= kRank[static_cast<std::size_t>(b)] ? a : b;
}

}  // namespace whirl::results
