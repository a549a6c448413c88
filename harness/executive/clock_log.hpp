// The firmware's clocks in the run's log: a row for each change of SYSCLK or a bus clock.
#pragma once
#include "results/event_log.hpp"
#include "results/report.hpp"

namespace whirl {

void log_clocks(const results::EventLog& events, results::Report& report);

}  // namespace whirl
