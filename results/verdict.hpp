// Who is at fault, and what follows from it: the one place that decides a verdict and its exit code.
//
//   Blame        evidence                                                     verdict       exit code
//   firmware     a fault of the core, a watchdog's reset, a lock-up, the      fail          1
//                plan's timeout, a failed expectation
//   user         plan, vehicle, board, image, option                          error         2
//   host         too slow, lacks something, interrupted, results lost         inconclusive  3
//   not_shown    what the plan asks was never seen to hold or not to hold     inconclusive  3
//   harness      a failed internal check, an emulator that crashed            error         4
//
//   none         nothing was judged (whirl fly), and nothing was at fault                     0
//   Within a plan    what was seen of the firmware stays, whatever follows. Of other reasons the
//                    first one stays, because what follows it may be its consequence; not_shown
//                    counts only where there is no other.
//   Between plans    4, then 2, 1, 3, 0
#pragma once
#include <string>
#include <vector>

namespace whirl {
struct Error;
}

namespace whirl::results {

enum class Verdict { pass, fail, inconclusive, error, none };
const char* name(Verdict verdict);

enum class Blame { firmware, user, host, not_shown, harness };
const char* name(Blame blame);
Blame blame_of(const Error& error);

struct Reason {
  Blame blame = Blame::harness;
  std::string what;  // one line
};

// `before` says where it came up: "in the second run: ".
Reason reason_of(const Error& error, const std::string& before = "");

Verdict verdict_of(Blame blame);
int exit_code_of(Blame blame);

// The reason that decides; null without any.
const Reason* deciding(const std::vector<Reason>& reasons);

// Of several plans.
int worse_exit_code(int a, int b);

}  // namespace whirl::results
