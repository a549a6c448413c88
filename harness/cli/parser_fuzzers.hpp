// whirl fuzz: the parsers under libFuzzer. Their programs are built by the preset `fuzz` (harness/fuzz), those of the smoke by
// the preset `sanitize`.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace whirl::cli {

struct ParserFuzzOptions {
  std::string root;        // of the checkout: seeds and dictionaries
  std::string build = {};  // of another preset; empty: ROOT/build/fuzz
  double seconds = 10.0;   // for each parser, or:
  std::int64_t runs = 0;   // so many inputs each, however long it takes
  std::uint64_t seed = 1;  // of the mutations; the corpus that earlier runs found counts too
  std::vector<std::string> only = {};  // names of parsers; empty: all
};

// Runs as many at a time as there are cores and prints a row as each ends. 0: nothing found; 1: a finding, with the
// path of the input that shows it; 2: not built, or no such parser.
int run_parser_fuzzers(const ParserFuzzOptions& options);

}  // namespace whirl::cli
