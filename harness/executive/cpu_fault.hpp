// A fault of the core as people read it.
#pragma once
#include "results/event_log.hpp"
#include "results/report.hpp"

namespace whirl {

results::CpuFaultRow describe(const results::CpuFaultRecord& fault);

}  // namespace whirl
