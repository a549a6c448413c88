// Who goes along with a run from outside of its plan, in the host's time: paces it, gives commands, watches.
//
//   Turn     at each step, after the plan's own turn and before the step is taken. What it commands takes
//            effect in this step: a plan's t:at of the same time does the same
//   Verdict  a run with a companion has none: what it commands is not in the plan. A fault of the
//            firmware stays one
#pragma once
#include <cstdint>
#include <string>

#include "base/result.hpp"
#include "harness/world/world.hpp"

namespace whirl {

class Companion {
 public:
  virtual ~Companion() = default;

  // False: the run shall end, in order. The commands that it gives at t_ns count no more then.
  // Errors  those of World::command
  virtual Result<bool> turn(std::int64_t t_ns, World& world) = 0;
  // What the target has done in the step that ended at t_ns.
  virtual void on_happened(std::int64_t t_ns, const io::Batch& happened, const World& world) = 0;
};

}  // namespace whirl
