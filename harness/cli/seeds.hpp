// Seeds as the command line has them: "7"; several as "2..21", "1,4,10..12".
//
//   Range   0 to 2^64 - 1 each; in all at most kMost_seeds, none twice
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl::cli {

inline constexpr std::size_t kMost_seeds = 10'000;

// Errors  bad_input: what in the text is none
Result<std::uint64_t> read_seed(const std::string& text);
Result<std::vector<std::uint64_t>> read_seeds(const std::string& text);

}  // namespace whirl::cli
