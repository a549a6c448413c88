#include "harness/cli/jobs.hpp"

#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>

#include "harness/base/argv.hpp"
#include "harness/base/interruption.hpp"
#include "harness/base/outside_signal.hpp"
#include "harness/cli/console.hpp"

namespace whirl::cli {
namespace {

struct Child {
  const PlanChoice* plan = nullptr;
  int output = -1;  // a nameless file in memory: no pipe that could fill up, no folder needed
};

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
[[noreturn]] void become(std::vector<std::string> words, int output, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(3);  // it died before we asked
  setpgid(0, 0);                      // a terminal's interrupt reaches it through the parent, once
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  std::vector<char*> argv = argv_of(words);
  execv("/proc/self/exe", argv.data());
  dprintf(STDERR_FILENO, "whirl: cannot start itself: %s\n", std::strerror(errno));
  _exit(3);
}

// 0: none could be started, errno says why.
pid_t start(const PlanChoice& plan, const RunOptions& options, int output) {
  const std::vector<std::string> words = arguments(plan, options);
  std::fflush(stdout);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) become(words, output, parent);
  return pid < 0 ? 0 : pid;
}

void print_all(int from) {
  std::array<char, 4096> piece;
  lseek(from, 0, SEEK_SET);
  for (;;) {
    const ssize_t n = read(from, piece.data(), piece.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    std::fwrite(piece.data(), 1, static_cast<std::size_t>(n), stdout);
  }
  std::fflush(stdout);
  close(from);
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
  Jobs(const std::vector<PlanChoice>& plans, const RunOptions& options, Tally& tally)
      : plans_(plans), options_(options), tally_(tally) {}

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
    const pid_t pid = output < 0 ? 0 : start(plan, options_, output);
    if (pid != 0) {
      running_[pid] = {&plan, output};
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

  void wait_for_one() {
    int status = 0;
    const pid_t pid = wait(&status);
    if (pid < 0 && errno == EINTR) return;
    WHIRL_CHECK(pid >= 0, errno);
    const auto it = running_.find(pid);
    if (it == running_.end()) return;
    print_all(it->second.output);
    tally_.add(code_of(status, *it->second.plan));
    running_.erase(it);
  }

  void pass_interruption_on() {
    tally_.add_not_run(plans_.size() - next_);
    next_ = plans_.size();
    if (passed_on_) return;
    for (const auto& [pid, child] : running_) kill(pid, interrupted_by());
    passed_on_ = true;
  }

  const std::vector<PlanChoice>& plans_;
  const RunOptions& options_;
  Tally& tally_;
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
