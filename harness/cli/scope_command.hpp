// whirl bench scope: what a bench measures, live in the terminal. Nothing is commanded: it reads the instruments and
// asks the ESC for its status, as `whirl bench check` does.
//
//   Terminal  a row per signal: value, lowest and highest of the window, a line of its last values. Keys: q ends, space
//             holds the picture, + and - halve and double the time of a column, r forgets lowest and highest
//   Elsewhere rows of text, "t_s signal value", one per signal and column of time
#pragma once
#include <string>

#include "harness/cli/composition.hpp"

namespace whirl::cli {

struct ScopeOptions {
  std::string name;       // of test_plans/benches, or a path
  double seconds = 0.0;   // 0: until q or Ctrl-C
  double column_s = 0.1;  // of time, behind one block
};

// 0: ended in order; 2: a link is not there; 3: one was unplugged
int bench_scope_command(const ScopeOptions& options, const Composition& composition);

}  // namespace whirl::cli
