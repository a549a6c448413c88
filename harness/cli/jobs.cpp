#include "harness/cli/jobs.hpp"

#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>

#include "base/argv.hpp"
#include "base/interruption.hpp"
#include "base/outside_signal.hpp"
#include "harness/cli/console.hpp"

namespace whirl::cli {
namespace {

struct Child {
  const PlanChoice* plan = nullptr;
  std::size_t slot = 0;  // among those that run
  int output = -1;       // a nameless file in memory: no pipe that could fill up, no folder needed
};

// A run is two processes that wait for each other in turn. Where there are not two cores for each job,
// both stay on one: nobody is woken on another core, and what one has written is in the other's cache.
// Two hovers at once on two cores: 4.0 s instead of 5.1.
std::vector<int> cores_for(std::size_t jobs) {
  cpu_set_t allowed;
  std::vector<int> cores;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return cores;
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(core, &allowed)) cores.push_back(core);
  }
  if (2 * jobs <= cores.size()) cores.clear();
  return cores;
}

void keep_to(int core) {
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(core, &only);
  sched_setaffinity(0, sizeof only, &only);
}

std::vector<std::string> arguments(const PlanChoice& plan, const RunOptions& options) {
  std::vector<std::string> all{"whirl", "run", "--only", plan.name};
  if (options.seed) all.insert(all.end(), {"--seed", std::to_string(*options.seed)});
  if (!options.out.empty()) all.insert(all.end(), {"--out", options.out});
  if (options.keep) all.emplace_back("--keep");
  if (options.twice) all.emplace_back("--twice");
  if (options.json) all.emplace_back("--json");
  all.insert(all.end(), {"--", plan.file});
  return all;
}

// In the child: nothing but the other program.
[[noreturn]] void become(std::vector<std::string> words, int output, pid_t parent, int core) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(3);  // it died before we asked
  if (core >= 0) keep_to(core);
  setpgid(0, 0);  // a terminal's interrupt reaches it through the parent, once
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  std::vector<char*> argv = argv_of(words);
  execv("/proc/self/exe", argv.data());
  dprintf(STDERR_FILENO, "whirl: cannot start itself: %s\n", std::strerror(errno));
  _exit(3);
}

// 0: none could be started, errno says why. core: to keep to; negative: any.
pid_t start(const PlanChoice& plan, const RunOptions& options, int output, int core) {
  const std::vector<std::string> words = arguments(plan, options);
  std::fflush(stdout);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) become(words, output, parent, core);
  return pid < 0 ? 0 : pid;
}

// What a child printed; 0, or the error that kept it from being read to its end.
int print_all(int from) {
  std::array<char, 4096> piece;
  lseek(from, 0, SEEK_SET);
  int error = 0;
  for (;;) {
    const ssize_t n = read(from, piece.data(), piece.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) error = errno;
    if (n <= 0) break;
    std::fwrite(piece.data(), 1, static_cast<std::size_t>(n), stdout);
  }
  close(from);
  return error;
}

const char* verdict_word(int code) {
  switch (code) {
    case 0:
      return "PASS";
    case 1:
      return "FAIL";
    case 3:
      return "INCONCLUSIVE";
    default:
      return "ERROR";
  }
}

int code_of(int status, const PlanChoice& plan) {
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  const int signal = WTERMSIG(status);
  const bool from_outside = is_from_outside(signal);
  std::printf("%s %s\n       its process was ended by signal %d (%s)\n",
              from_outside ? "INCONCLUSIVE" : "ERROR", plan.name.c_str(), signal,
              strsignal(signal));
  return from_outside ? 3 : 4;
}

class Jobs {
 public:
  // The longest plans first, as far as their time-outs tell: the last one to end runs alone.
  Jobs(const std::vector<PlanChoice>& plans, const RunOptions& options, Tally& tally)
      : plans_(plans),
        options_(options),
        tally_(tally),
        cores_(cores_for(static_cast<std::size_t>(options.jobs))) {
    std::stable_sort(plans_.begin(), plans_.end(), [](const PlanChoice& a, const PlanChoice& b) {
      return a.timeout_ns > b.timeout_ns;
    });
  }

  void run() {
    while (next_ < plans_.size() || !running_.empty()) {
      if (interrupted_by() != 0) pass_interruption_on();
      while (wants_more() && start_next()) {
      }
      if (!running_.empty()) wait_for_one();
    }
  }

 private:
  bool wants_more() const {
    return next_ < plans_.size() && running_.size() < static_cast<std::size_t>(options_.jobs);
  }

  // False: not now; a child that ends may make room.
  bool start_next() {
    const PlanChoice& plan = plans_[next_];
    const int output = memfd_create("whirl-outcome", MFD_CLOEXEC);
    const std::size_t slot = free_slot();
    const int core = cores_.empty() ? -1 : cores_[slot % cores_.size()];
    const pid_t pid = output < 0 ? 0 : start(plan, options_, output, core);
    if (pid != 0) {
      running_[pid] = {&plan, slot, output};
      ++next_;
      return true;
    }
    const int why = errno;
    if (output >= 0) close(output);
    if (!running_.empty()) return false;
    std::printf("INCONCLUSIVE %s\n       cannot start a process for it: %s\n", plan.name.c_str(),
                std::strerror(why));
    tally_.add(3);
    ++next_;
    return true;
  }

  std::size_t free_slot() const {
    const auto taken = [this](std::size_t slot) {
      return std::any_of(running_.begin(), running_.end(),
                         [slot](const auto& child) { return child.second.slot == slot; });
    };
    std::size_t slot = 0;
    while (taken(slot)) ++slot;
    return slot;
  }

  void wait_for_one() {
    int status = 0;
    const pid_t pid = wait(&status);
    if (pid < 0 && errno == EINTR) return;
    WHIRL_CHECK(pid >= 0, errno);
    const auto it = running_.find(pid);
    if (it == running_.end()) return;
    const PlanChoice& plan = *it->second.plan;
    const int error = print_all(it->second.output);
    const int code = code_of(status, plan);
    if (error != 0) {
      std::printf(
          "%s %s\n       what its process printed cannot be read: %s; its results are written\n",
          verdict_word(code), plan.name.c_str(), std::strerror(error));
    }
    std::fflush(stdout);
    tally_.add(code);
    running_.erase(it);
  }

  void pass_interruption_on() {
    tally_.add_not_run(plans_.size() - next_);
    next_ = plans_.size();
    if (passed_on_) return;
    for (const auto& [pid, child] : running_) kill(pid, interrupted_by());
    passed_on_ = true;
  }

  std::vector<PlanChoice> plans_;
  const RunOptions& options_;
  Tally& tally_;
  const std::vector<int> cores_;  // for the slots; empty: each job goes where it likes
  std::map<pid_t, Child> running_;
  std::size_t next_ = 0;
  bool passed_on_ = false;
};

}  // namespace

void run_in_processes(const std::vector<PlanChoice>& plans, const RunOptions& options,
                      Tally& tally) {
  Jobs(plans, options, tally).run();
}

}  // namespace whirl::cli
