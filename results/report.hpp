// What is told of one run: the verdict, every expectation with what it measured, and the figures.
//
//   Units    an expectation shows its numbers in the unit that the plan wrote; all else is SI
//   Clock    host times are for people and never for verdicts
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "results/flight_log/flight_logs.hpp"
#include "results/verdict.hpp"

namespace whirl::results {

struct Expectation {
  std::string name;
  Verdict verdict = Verdict::fail;
  std::string how;             // "at most", "at least", "within", "equal", "holds"
  double measured = 0.0;       // in `unit`; NaN: could not be measured
  std::optional<double> low;   // in `unit`
  std::optional<double> high;  // in `unit`
  std::string unit;            // as written in the plan: "ms"; "" for a bare number
  double margin = 0.0;         // to the nearer limit, negative when failed, in `unit`
  bool marginal = false;       // met, but by less than the measurement is accurate
  std::string place;           // "hover.lua:31"
  double t_s = 0.0;            // when it was judged, or the worst value happened
  std::string note;            // "never reached", "2 of 1000 periods late"

  // For the page: the signals it was measured on, over which time, and whether its limits are levels
  // of the signal itself (and not of a time or a mean of it).
  std::vector<std::string> signals;
  double from_s = 0.0, to_s = 0.0;
  bool level = false;
  std::vector<double> limits_SI;

  std::string limit_text() const;  // "at most 50 ms"
};

// A distribution with its samples, for a histogram.
struct Histogram {
  std::string name;
  std::string unit;  // of the samples: "s"
  std::vector<double> samples;
  double limit = 0.0;
};

// A watched function, over the whole run.
struct TaskRow {
  std::string name;
  std::size_t calls = 0;
  double period_mean_s = 0, period_max_s = 0;
  double execution_p50_s = 0, execution_p99_s = 0, execution_max_s = 0;
  double response_p99_s = 0, response_max_s = 0;
  double latency_max_s = 0;  // of the interrupts that called it; NaN: none did
  double execution_min_s = 0;
  // Of HCLK; NaN: no code, or not known.
  double execution_min_cycles = 0, execution_p50_cycles = 0, execution_p99_cycles = 0,
         execution_max_cycles = 0, response_max_cycles = 0;
};

// An exception that was requested, over the whole run.
struct InterruptRow {
  std::uint32_t exception = 0;  // 16 and above: interrupt 0 and above
  std::string handler;          // empty: not known
  std::size_t requests = 0;
  double latency_mean_s = 0, latency_max_s = 0, latency_max_at_s = 0;
};

struct FaultRow {
  std::string kind;
  std::string target;  // "i2c3 0x2A"
  double start_s = 0;
  double end_s = 0;       // infinity: to the end
  double applied_s = -1;  // negative: nobody applied it
};

struct Note {
  double t_s = 0;
  std::string who;  // "plan", "MPU6000", "I2C3"
  std::string text;
};

// A number of this copy of the hardware, as drawn from the seed.
struct PartRow {
  std::string name;  // "divider.a.upper"
  double value = 0;  // SI
  std::string unit;  // "" is a share of the nominal
};

// Where the host's time went.
struct HostTimes {
  double total_s = 0;
  double start_s = 0;        // until the target had started
  double target_wait_s = 0;  // the world was done, the target was not
  double world_s = 0;        // physics, beside the target
  double script_s = 0;       // the plan's Lua
  double logging_s = 0;      // records, digest
  double results_s = 0;      // writing this folder
};

struct CpuFaultRow {
  std::string name;       // "HardFault"
  std::string where;      // "fw::crash at 0x08001234"
  std::string registers;  // one per line
  std::string backtrace;  // one frame per line
  double t_s = 0;
};

struct Report {
  std::string plan, file;
  std::vector<std::string> tags;
  // What has been seen against a pass, in order. conclude() draws the next three from it and from the
  // expectations.
  std::vector<Reason> reasons;
  bool judged = true;  // false: what was expected is told and decides nothing (whirl fly)
  // Why nothing that was seen of the firmware counts, for or against it: a bench's host was late. Empty: it does.
  std::string untimely;
  Verdict verdict = Verdict::error;
  Blame blame = Blame::harness;  // of all but pass and none
  std::string reason;            // one line; empty for these

  std::uint64_t seed = 0;
  std::string digest;
  double virtual_s = 0;
  HostTimes host;
  std::string timing_profile;  // "8 ns per instruction"
  std::vector<std::pair<std::string, std::string>> versions;
  std::vector<PartRow> parts;       // empty: the drawing itself
  std::vector<std::string> doubts;  // what speaks against a part's file; no verdict follows from it
  std::vector<Expectation> expectations;
  std::vector<Histogram> histograms;
  std::vector<TaskRow> tasks;
  std::vector<InterruptRow> interrupts;
  std::vector<FaultRow> faults;
  std::vector<Note> findings;
  std::vector<Note> log;
  std::vector<Note> steps;  // t:step
  std::vector<CpuFaultRow> cpu_faults;
  std::vector<FlightLogRow> flight_logs;
  std::string statistics_json;  // the (first) board's own words; may be empty
  std::vector<std::pair<std::string, std::string>> boards;  // of nodes with names: what each said

  double speed_factor() const { return host.total_s > 0 ? virtual_s / host.total_s : 0.0; }
};

// The verdict that follows from the reasons and the expectations; again and again the same.
void conclude(Report& report);

int exit_code(const Report& report);  // of its verdict; see verdict.hpp

}  // namespace whirl::results
