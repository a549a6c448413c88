#include "harness/cli/console.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <sstream>
#include <tuple>

#include "base/text.hpp"
#include "harness/cli/tally.hpp"

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
  const std::string word = e.verdict == results::Verdict::inconclusive ? " (not shown)" : "";
  std::string line = "       " + e.name + word;
  if (e.how != "holds") line += ": " + with_unit(e.measured, e.unit) + ", wanted " + e.limit_text();
  if (!e.note.empty()) line += "  [" + e.note + "]";
  if (!e.place.empty()) line += "  " + e.place;
  return printable_line(line) + "\n";
}

// Each line of it on a line of its own, set in: none can pass for a line of ours.
std::string set_in(const std::string& text) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    out += "       " + printable_line(line) + "\n";
  }
  return out;
}

// The reason that decides, then the others. Failed expectations have lines of their own.
std::string reason_lines(const results::Report& r) {
  std::string text;
  bool decided = false;
  for (const results::Reason& reason : r.reasons) {
    const bool decides = !decided && reason.what == r.reason;
    decided = decided || decides;
    if (decides) text = set_in(reason.what) + text;
    if (!decides) text += set_in("also: " + reason.what);
  }
  const bool of_expectation = r.verdict == results::Verdict::fail ||
                              (r.blame == results::Blame::not_shown && !r.expectations.empty());
  if (!decided && !of_expectation) text = set_in(r.reason) + text;
  return text;
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
    case results::Verdict::none:
      return "FLOWN ";
  }
  return "?";
}

}  // namespace

int complain(const Error& error) {
  std::fprintf(stderr, "whirl: %s\n", printable_line(error.message()).c_str());
  return results::exit_code_of(results::blame_of(error));
}

bool is_terminal() {
  return isatty(STDERR_FILENO) != 0;
}

ProgressSink progress_line(const std::string& plan) {
  if (!is_terminal()) return nullptr;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  return [plan, begin, shown = begin](const Progress& p) mutable {
    const Clock::time_point now = Clock::now();
    if (now - shown < std::chrono::milliseconds(100)) return;
    shown = now;
    const double factor = p.t_s / std::chrono::duration<double>(now - begin).count();
    std::fprintf(stderr, "\r\033[K%s  %.1f s  %.1fx  %s%s%s", plan.c_str(), p.t_s, factor,
                 p.world.status().c_str(), p.step.empty() ? "" : "  ",
                 printable_line(p.step).c_str());
    std::fflush(stderr);
  };
}

void clear_progress() {
  if (is_terminal()) std::fprintf(stderr, "\r\033[K");
}

std::string outcome(const Finished& finished) {
  const results::Report& r = finished.report;
  std::string text = word(r.verdict) + r.plan;
  if (!r.digest.empty()) {  // it ran
    std::size_t passed = 0;
    for (const auto& e : r.expectations) passed += e.verdict == results::Verdict::pass ? 1 : 0;
    text += "  " + std::to_string(passed) + "/" + std::to_string(r.expectations.size()) +
            " expectations, " + number(r.virtual_s) + " s at " + number(r.speed_factor()) +
            "x, seed " + std::to_string(r.seed) + ", digest " + r.digest;
  }
  text += "\n";
  text += reason_lines(r);
  for (const std::string& doubt : r.doubts) text += set_in("doubt: " + doubt);
  for (const results::CpuFaultRow& f : r.cpu_faults) text += set_in(f.backtrace);
  for (const auto& e : r.expectations) {
    if (e.verdict != results::Verdict::pass) text += expectation_line(e);
  }
  if (!finished.folder.empty()) {
    text += "       " + shown_path(finished.folder + "/index.html") + "\n";
  }
  return text;
}

std::size_t Tally::plans() const {
  return std::accumulate(counts_.begin(), counts_.end(), not_run_);
}

std::string Tally::summary() const {
  static constexpr std::array kWords{"passed", "failed", "bad input", "inconclusive",
                                     "internal errors"};
  std::string text = std::to_string(counts_[0]) + " passed";
  for (const std::size_t code : {1, 2, 3, 4}) {
    if (counts_[code] == 0) continue;
    text += ", " + std::to_string(counts_[code]) + " " + kWords[code];
  }
  if (not_run_ > 0) text += ", " + std::to_string(not_run_) + " not run";
  return text + "\n";
}

namespace {

bool output_was_closed = false;

}  // namespace

void hold_standard_streams() {
  output_was_closed = fcntl(STDOUT_FILENO, F_GETFD) < 0;
  for (int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) < 0) std::ignore = open("/dev/null", O_RDWR);  // takes its number
  }
}

int code_with_output(int code) {
  const bool arrived = std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && !output_was_closed;
  if (arrived) return code;
  std::fprintf(stderr, "whirl: standard output cannot be written; what was printed is lost\n");
  return results::worse_exit_code(code, 3);
}

}  // namespace whirl::cli
