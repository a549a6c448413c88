#include "harness/pacing/real_time.hpp"

#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstring>

namespace whirl::pacing {
namespace {

// Above ordinary work, below the kernel's interrupt threads, which stand at 50.
constexpr int kPriority = 49;

}  // namespace

RealTime take_real_time() {
  RealTime got;
  sched_param param{};
  param.sched_priority = kPriority;
  // Threads made from here on are ordinary ones: what they do must not keep the paced one waiting.
  got.first_in_line = sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &param) == 0;
  got.told = got.first_in_line ? "SCHED_FIFO " + std::to_string(kPriority)
                               : std::string("not SCHED_FIFO: ") + std::strerror(errno) +
                                     " (ulimit -r 49 in /etc/security/limits.conf allows it)";
  got.memory_held = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  got.told += got.memory_held ? ", memory locked"
                              : std::string(", memory not locked: ") + std::strerror(errno) +
                                    " (ulimit -l unlimited allows it)";
  return got;
}

void give_back_real_time() {
  const sched_param ordinary{};
  sched_setscheduler(0, SCHED_OTHER, &ordinary);
  munlockall();
}

}  // namespace whirl::pacing
