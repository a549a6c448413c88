#include "harness/cli/jobs.hpp"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>

#include "base/argv.hpp"
#include "base/interruption.hpp"
#include "base/outside_signal.hpp"
#include "harness/cli/job_command.hpp"
#include "harness/cli/memory_file.hpp"
#include "harness/job/job.hpp"
#include "results/read_run.hpp"

namespace whirl::cli {
namespace {

struct Child {
  const PlanChoice* plan = nullptr;
  std::size_t slot = 0;  // among those that run
  MemoryFile output, report;
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

Job job_of(const PlanChoice& plan, const RunOptions& options, const std::string& results) {
  return {plan.file, plan.name,    plan.seed,     options.settings,
          results,   options.keep, options.twice, options.calibrations};
}

// In the child: nothing but the other program.
[[noreturn]] void become(int job, int output, int report, pid_t parent, int core) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(3);  // it died before we asked
  if (core >= 0) keep_to(core);
  setpgid(0, 0);  // a terminal's interrupt reaches it through the parent, once
  lseek(job, 0, SEEK_SET);
  // The report last: what has its number by chance is not needed any more.
  const bool report_stays = report == kReport_fd;
  const bool placed = dup2(job, STDIN_FILENO) >= 0 && dup2(output, STDOUT_FILENO) >= 0 &&
                      dup2(output, STDERR_FILENO) >= 0 &&
                      (report_stays ? fcntl(report, F_SETFD, 0) : dup2(report, kReport_fd)) >= 0;
  if (!placed) {
    dprintf(output, "whirl: a process cannot be given its files: %s\n", std::strerror(errno));
    _exit(3);
  }
  std::vector<std::string> words{"whirl", "job"};
  std::vector<char*> argv = argv_of(words);
  execv("/proc/self/exe", argv.data());
  dprintf(STDERR_FILENO, "whirl: cannot start itself: %s\n", std::strerror(errno));
  _exit(3);
}

// 0: none could be started, errno says why. core: to keep to; negative: any.
pid_t start(const Job& job, const Child& child, int core) {
  const MemoryFile order("whirl-job");
  if (!order.is_open() || !write_whole(order.fd(), job_text(job))) return 0;
  std::fflush(stdout);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) become(order.fd(), child.output.fd(), child.report.fd(), parent, core);
  return pid < 0 ? 0 : pid;
}

int code_of(int status) {
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  return is_from_outside(WTERMSIG(status)) ? 3 : 4;
}

std::string words_for_end(int status) {
  if (WIFEXITED(status)) return "";
  const int signal = WTERMSIG(status);
  return "its process was ended by signal " + std::to_string(signal) + " (" + strsignal(signal) +
         ")";
}

class Jobs {
 public:
  // The longest plans first, as far as their time-outs tell: the last one to end runs alone.
  Jobs(const std::vector<PlanChoice>& plans, const RunOptions& options, const std::string& results,
       Outcomes& outcomes)
      : plans_(plans),
        options_(options),
        results_(results),
        outcomes_(outcomes),
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
    const std::size_t slot = free_slot();
    const int core = cores_.empty() ? -1 : cores_[slot % cores_.size()];
    Child child{&plan, slot, MemoryFile("whirl-outcome"), MemoryFile("whirl-report")};
    const bool files = child.output.is_open() && child.report.is_open();
    const pid_t pid = files ? start(job_of(plan, options_, results_), child, core) : 0;
    if (pid != 0) {
      running_.emplace(pid, std::move(child));
      ++next_;
      return true;
    }
    const int why = errno;
    if (!running_.empty()) return false;
    outcomes_.add_lost(plan.name, plan.file, 3,
                       std::string("cannot start a process for it: ") + std::strerror(why));
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
    read_report(it->second, status);
    running_.erase(it);
  }

  void read_report(const Child& child, int status) {
    std::string output, text;
    if (!read_whole(child.output.fd(), output)) {
      std::printf("whirl: what the process of %s printed cannot be read: %s\n",
                  child.plan->name.c_str(), std::strerror(errno));
    }
    std::fwrite(output.data(), 1, output.size(), stdout);
    const bool is_read = read_whole(child.report.fd(), text);
    const std::string unread = is_read ? "" : std::strerror(errno);
    const auto report = read_job_report(text);
    const auto run = report ? results::read_run(report.value().run) : report.error();
    if (is_read && run && code_of(status) == report.value().exit_code) {
      return outcomes_.add({run.value(), report.value().folder}, report.value().outcome,
                           report.value().run);
    }
    lose(*child.plan, status, unread);
  }

  // The process gave its exit code, or not even that.
  void lose(const PlanChoice& plan, int status, const std::string& unread) {
    int code = code_of(status);
    std::string what = words_for_end(status);
    if (what.empty()) {
      what = "its report " + (unread.empty() ? "was not written" : "cannot be read: " + unread);
    }
    if (code == 0) code = 3;  // its line in the history is lost
    outcomes_.add_lost(plan.name, plan.file, code, what);
  }

  void pass_interruption_on() {
    outcomes_.add_not_run(plans_.size() - next_);
    next_ = plans_.size();
    if (passed_on_) return;
    for (const auto& [pid, child] : running_) kill(pid, interrupted_by());
    passed_on_ = true;
  }

  std::vector<PlanChoice> plans_;
  const RunOptions& options_;
  const std::string& results_;
  Outcomes& outcomes_;
  const std::vector<int> cores_;  // for the slots; empty: each job goes where it likes
  std::map<pid_t, Child> running_;
  std::size_t next_ = 0;
  bool passed_on_ = false;
};

}  // namespace

void run_in_processes(const std::vector<PlanChoice>& plans, const RunOptions& options,
                      const std::string& results, Outcomes& outcomes) {
  Jobs(plans, options, results, outcomes).run();
}

}  // namespace whirl::cli
