#include "results/report.hpp"

#include <cmath>
#include <cstdio>

namespace whirl::results {
namespace {

std::string shown_number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

}  // namespace

std::string Expectation::limit_text() const {
  const std::string tail = unit.empty() ? "" : " " + unit;
  if (low && high) return how + " " + shown_number(*low) + " .. " + shown_number(*high) + tail;
  if (high) return how + " " + shown_number(*high) + tail;
  if (low) return how + " " + shown_number(*low) + tail;
  return how;
}

namespace {

std::string sentence(const Expectation& e) {
  std::string text = e.name + ": ";
  if (e.verdict == Verdict::inconclusive) return text + e.note;
  if (std::isnan(e.measured)) return text + (e.note.empty() ? "nothing to measure" : e.note);
  text += shown_number(e.measured) + (e.unit.empty() ? "" : " " + e.unit);
  return text + ", wanted " + e.limit_text();
}

// One reason for all expectations of this verdict, that names the first.
void add_reason(std::vector<Reason>& reasons, const Report& report, Verdict verdict, Blame blame) {
  const Expectation* first = nullptr;
  std::size_t count = 0;
  for (const Expectation& e : report.expectations) {
    if (e.verdict != verdict) continue;
    ++count;
    if (first == nullptr) first = &e;
  }
  if (first == nullptr) return;
  const std::string more = count == 1 ? "" : " (and " + std::to_string(count - 1) + " more)";
  reasons.push_back({blame, sentence(*first) + more});
}

}  // namespace

void conclude(Report& report) {
  std::vector<Reason> all = report.reasons;
  if (!report.untimely.empty()) {
    std::erase_if(all, [](const Reason& r) { return r.blame == Blame::firmware; });
    all.push_back({Blame::host, report.untimely});
  }
  const bool timely = report.judged && report.untimely.empty();
  if (timely) add_reason(all, report, Verdict::fail, Blame::firmware);
  if (report.judged) add_reason(all, report, Verdict::inconclusive, Blame::not_shown);
  if (report.judged && report.expectations.empty()) {
    all.push_back({Blame::user, report.file + ": the plan expects nothing, so it could not fail"});
  }
  const Reason* decides = deciding(all);
  const Verdict good = report.judged ? Verdict::pass : Verdict::none;
  report.verdict = decides == nullptr ? good : verdict_of(decides->blame);
  report.blame = decides == nullptr ? Blame::harness : decides->blame;
  report.reason = decides == nullptr ? "" : decides->what;
}

int exit_code(const Report& report) {
  const bool good = report.verdict == Verdict::pass || report.verdict == Verdict::none;
  return good ? 0 : exit_code_of(report.blame);
}

}  // namespace whirl::results
