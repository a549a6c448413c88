// The watched functions and the exceptions of a run, one row each, over its whole length.
#pragma once
#include <string>
#include <vector>

#include "results/event_log.hpp"
#include "results/report.hpp"

namespace whirl {

std::vector<results::TaskRow> task_table(const std::vector<std::string>& watch,
                                         const results::EventLog& events);

// The exceptions that were requested; the board's own words name the handlers.
std::vector<results::InterruptRow> interrupt_table(const results::EventLog& events);

}  // namespace whirl
