#include "harness/cli/console.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace whirl::cli {
namespace {

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

std::string with_unit(double x, const std::string& unit) {
  return std::isnan(x) ? "nothing" : number(x) + (unit.empty() ? "" : " " + unit);
}

std::string expectation_line(const results::Expectation& e) {
  std::string line =
      "       " + e.name + ": " + with_unit(e.measured, e.unit) + ", wanted " + e.limit_text();
  if (!e.note.empty()) line += "  [" + e.note + "]";
  if (!e.place.empty()) line += "  " + e.place;
  return line + "\n";
}

std::string word(results::Verdict verdict) {
  switch (verdict) {
    case results::Verdict::pass:
      return "PASS ";
    case results::Verdict::fail:
      return "FAIL ";
    case results::Verdict::inconclusive:
      return "INCONCLUSIVE ";
    case results::Verdict::error:
      return "ERROR ";
  }
  return "?";
}

}  // namespace

int complain(const Error& error) {
  std::fprintf(stderr, "whirl: %s\n", error.message().c_str());
  switch (error.kind) {
    case ErrorKind::bad_input:
      return 2;
    case ErrorKind::host:
      return 3;
    case ErrorKind::internal:
      return 4;
  }
  return 4;
}

bool is_terminal() {
  return isatty(STDERR_FILENO) != 0;
}

ProgressSink progress_line(const std::string& plan) {
  if (!is_terminal()) return nullptr;
  return [plan](const Progress& p) {
    const double factor = p.host_s > 0.0 ? p.t_s / p.host_s : 0.0;
    std::fprintf(stderr, "\r\033[K%s  %.1f s  %.1fx  %s%s%s", plan.c_str(), p.t_s, factor,
                 p.world.status().c_str(), p.step.empty() ? "" : "  ", p.step.c_str());
    std::fflush(stderr);
  };
}

void clear_progress() {
  if (is_terminal()) std::fprintf(stderr, "\r\033[K");
}

std::string outcome(const Finished& finished) {
  const results::Report& r = finished.report;
  std::string text = word(r.verdict) + r.plan;
  if (!finished.folder.empty()) {
    std::size_t passed = 0;
    for (const auto& e : r.expectations) passed += e.verdict == results::Verdict::pass ? 1 : 0;
    text += "  " + std::to_string(passed) + "/" + std::to_string(r.expectations.size()) +
            " expectations, " + number(r.virtual_s) + " s at " + number(r.speed_factor()) +
            "x, seed " + std::to_string(r.seed) + ", digest " + r.digest;
  }
  text += "\n";
  const bool told = r.verdict == results::Verdict::fail && r.cpu_faults.empty();
  if (!r.reason.empty() && !told) text += "       " + r.reason + "\n";
  for (const results::CpuFaultRow& f : r.cpu_faults) {
    std::string indented = "       ";
    for (char c : f.backtrace) indented += c == '\n' ? std::string("\n       ") : std::string(1, c);
    text += indented.substr(0, indented.find_last_not_of(" \n") + 1) + "\n";
  }
  for (const auto& e : r.expectations) {
    if (e.verdict != results::Verdict::pass) text += expectation_line(e);
  }
  if (!finished.folder.empty()) {
    text += "       " + shown_path(finished.folder + "/index.html") + "\n";
  }
  return text;
}

std::string summary(int passed, int failed, int inconclusive, int errors) {
  std::string text = std::to_string(passed) + " passed";
  if (failed > 0) text += ", " + std::to_string(failed) + " failed";
  if (inconclusive > 0) text += ", " + std::to_string(inconclusive) + " inconclusive";
  if (errors > 0) text += ", " + std::to_string(errors) + " with errors";
  return text + "\n";
}

}  // namespace whirl::cli
