// What a target that cannot wait (a bench) has held of its pace, for the report.
#pragma once
#include "harness/target/target.hpp"
#include "results/report.hpp"

namespace whirl {

// Adds the lateness of each step as a histogram and a line of the log. A host that was late beyond what
// plan or bench allow takes the run's verdict away (Report::untimely). held: null, or of a run that may have no step.
void report_pace(const HeldPace* held, double t_s, results::Report& report);

}  // namespace whirl
