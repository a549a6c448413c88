// `whirl job`: the process of one run; for whirl itself (jobs.hpp), not for people.
//
//   In   a Job (harness/job/job.hpp) on standard input
//   Out  its report on file descriptor 3; where that cannot be written, its outcome on standard output
#pragma once
#include "harness/cli/composition.hpp"

namespace whirl::cli {

inline constexpr int kReport_fd = 3;

int job_command(const Composition& composition);

}  // namespace whirl::cli
