// whirl bench check: is all there that a bench names, how fast and how steady is each link. whirl parity: two runs
// side by side.
#pragma once
#include <string>

#include "harness/cli/composition.hpp"

namespace whirl::cli {

struct BenchOptions {
  std::string name;      // of test_plans/benches, or a path
  double seconds = 2.0;  // of each measurement
};

// Nothing is commanded but reads of the ESC's status. 0: all is there; 2: something is missing, each told with its
// cure.
int bench_check_command(const BenchOptions& options, const Composition& composition);

struct ParityOptions {
  std::string first, second;  // folders of runs
  std::string page;           // where the page goes; empty: parity.html in the second's folder
};

int parity_command(const ParityOptions& options);

}  // namespace whirl::cli
