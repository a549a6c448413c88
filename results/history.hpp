// What earlier runs measured: results/history.sqlite, one row per expectation and run.
//
//   Schema   numbered (PRAGMA user_version). Files of before the number are taken on; a newer schema is
//            left alone and said to be one
//   Damage   recall() checks the file's integrity first: rows of a damaged file are not to be had
//   Locked   by another process for longer than the patience: an error, and the run is not in it.
//            Writers hold it for milliseconds, so that this is a stopped one, or a full disk
#pragma once
#include <chrono>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "results/report.hpp"

namespace whirl::results {

struct PastExpectation {
  std::string when;  // host time of the run
  std::string plan, name, verdict, unit, seed;
  double measured = 0, margin = 0;  // NaN: could not be measured
  // Of image, plan, board and vehicle of the run, "flight.elf fnv1a64:...", one after the other; empty in
  // rows of before they were kept.
  std::string inputs;
};

inline constexpr int kHistory_schema = 2;
inline constexpr std::chrono::milliseconds kHistory_patience{3000};

Result<Done> remember(const std::string& file, const Report& report,
                      std::chrono::milliseconds patience = kHistory_patience);

// The last `runs` runs of each expectation that matches, oldest first; empty texts match all.
Result<std::vector<PastExpectation>> recall(const std::string& file, const std::string& plan,
                                            const std::string& expectation, int runs,
                                            std::chrono::milliseconds patience = kHistory_patience);

}  // namespace whirl::results
