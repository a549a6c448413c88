// whirl fuzz: what no hand-written test would try, by seed. Finds bugs of ours, so a find is exit 4.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace whirl::cli {

struct FuzzOptions {
  std::vector<std::string> names;  // of fuzzers; empty: all
  bool smoke = false;              // a few seconds of each
  std::uint64_t seeds = 0;         // of each; 0: as many as the fuzzer's own night takes
  std::uint64_t first = 0;
};

int fuzz_command(const FuzzOptions& options);

}  // namespace whirl::cli
