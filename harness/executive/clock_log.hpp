// The firmware's clocks in the run's log: a row for each change of SYSCLK or a bus clock.
#pragma once
#include <string>

#include "results/event_log.hpp"
#include "results/report.hpp"

namespace whirl {

// `who` says it: "RCC".
void log_clocks(const results::EventLog& events, const std::string& who, results::Report& report);

}  // namespace whirl
