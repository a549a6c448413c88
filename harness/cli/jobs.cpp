#include "harness/cli/jobs.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <map>

#include "harness/cli/console.hpp"
#include "results/report.hpp"

namespace whirl::cli {
namespace {

struct Child {
  const PlanChoice* plan = nullptr;
  std::FILE* output = nullptr;  // a nameless file: no pipe that could fill up
};

std::vector<std::string> arguments(const PlanChoice& plan, const RunOptions& options) {
  std::vector<std::string> all{"whirl", "run", plan.file, "--only", plan.name};
  if (options.seed) all.insert(all.end(), {"--seed", std::to_string(*options.seed)});
  if (options.keep) all.emplace_back("--keep");
  if (options.twice) all.emplace_back("--twice");
  if (options.json) all.emplace_back("--json");
  return all;
}

pid_t start(const PlanChoice& plan, const RunOptions& options, std::FILE* output) {
  const pid_t pid = fork();
  if (pid != 0) return pid;
  dup2(fileno(output), STDOUT_FILENO);
  dup2(fileno(output), STDERR_FILENO);
  std::vector<std::string> words = arguments(plan, options);
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv("/proc/self/exe", argv.data());
  _exit(4);
}

void print_all(std::FILE* from) {
  std::rewind(from);
  std::array<char, 4096> piece;
  for (std::size_t n; (n = std::fread(piece.data(), 1, piece.size(), from)) > 0;) {
    std::fwrite(piece.data(), 1, n, stdout);
  }
  std::fflush(stdout);
  std::fclose(from);
}

int code_of(int status, const PlanChoice& plan) {
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  std::printf("ERROR %s\n       ended by signal %d\n", plan.name.c_str(), WTERMSIG(status));
  return 4;
}

}  // namespace

int run_in_processes(const std::vector<PlanChoice>& plans, const RunOptions& options) {
  std::map<pid_t, Child> running;
  int code = 0, passed = 0, failed = 0, inconclusive = 0, errors = 0;
  std::size_t next = 0;
  while (next < plans.size() || !running.empty()) {
    while (next < plans.size() && running.size() < static_cast<std::size_t>(options.jobs)) {
      std::FILE* output = std::tmpfile();
      WHIRL_CHECK(output != nullptr);
      std::fflush(stdout);
      running[start(plans[next], options, output)] = {&plans[next], output};
      ++next;
    }
    int status = 0;
    const pid_t pid = wait(&status);
    const auto it = running.find(pid);
    if (it == running.end()) continue;
    print_all(it->second.output);
    const int ended = code_of(status, *it->second.plan);
    ++(ended == 0 ? passed : ended == 1 ? failed : ended == 3 ? inconclusive : errors);
    code = results::worse_exit_code(code, ended);
    running.erase(it);
  }
  if (!options.json) std::fputs(summary(passed, failed, inconclusive, errors).c_str(), stdout);
  return code;
}

}  // namespace whirl::cli
