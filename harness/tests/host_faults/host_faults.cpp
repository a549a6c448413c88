// host_faults WHIRL INJECTOR [--sample N [--seed S]]: lets each site of whirl that calls the system fail,
// at its first and at its last occurrence, under real runs, and holds the verdicts against the rules.
//
//   Runs    a plan that passes, one that fails, and both under --jobs 2, on a real image
//   Right   0 only with all results whole; 1 where an expectation was seen to fail, and it is told;
//           3 with words; 2 where the user may mend it (no access, no such file); never 4, never a signal;
//           an interrupted call (EINTR) changes nothing at all; an end in time, and no emulator left behind
//   Sample  a seeded choice of the faults, for the quick test; without it, all
#include <dirent.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/personality.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "base/scratch_folder.hpp"
#include "harness/tests/host_faults/site_table.hpp"

namespace whirl::host_faults {
namespace {

namespace fs = std::filesystem;
constexpr auto kLongest = std::chrono::seconds(90);  // of the host, as a safety

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The table in a file that the processes map.
class SharedTable {
 public:
  explicit SharedTable(const std::string& path) : path_(path) {
    const int fd = open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (fd < 0 || ftruncate(fd, sizeof(SiteTable)) != 0) std::abort();
    map_ = mmap(nullptr, sizeof(SiteTable), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    close(fd);
    if (map_ == MAP_FAILED) std::abort();
  }
  ~SharedTable() { munmap(map_, sizeof(SiteTable)); }
  SharedTable(const SharedTable&) = delete;
  SharedTable& operator=(const SharedTable&) = delete;
  SiteTable& operator*() { return *static_cast<SiteTable*>(map_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  void* map_ = nullptr;
};

struct Case {
  const char* name;
  std::vector<std::string> plans;
  int right;  // the exit code without a fault
};

struct Fault {
  std::uint64_t site = 0;
  std::uint32_t occurrence = 0;
  int error = 0;
  std::string call;
  bool judged = false;  // the plan had been judged by then
};

struct Ran {
  int code = -1;  // 128 + n: ended by signal n
  bool late = false, orphans = false, hit = false;
  std::string text;
  std::string results;
};

class Driver {
 public:
  Driver(std::string whirl, std::string injector)
      : whirl_(std::move(whirl)), injector_(std::move(injector)) {
    plan("passes", "t:expect(t:value 'height'):at_most '50 m'");
    plan("fails", "t:expect(t:value 'height', 'it flies high'):at_least '50 m'");
  }

  Ran run(const Case& c, const Fault* fault, std::vector<Fault>* found) {
    const std::string tag = std::to_string(++runs_);
    SharedTable table(folder_.file("table" + tag));
    if (fault != nullptr) {
      (*table).site = fault->site;
      (*table).occurrence = fault->occurrence;
      (*table).error = fault->error;
    }
    Ran ran;
    ran.results = folder_.file("results" + tag);
    const std::string output = folder_.file("output" + tag);
    const pid_t pid = fork();
    if (pid == 0) become(c, table.path(), ran.results, output);
    wait_for(pid, ran);
    ran.orphans = left_behind(table.path());
    ran.text = read_file(output);
    ran.hit = (*table).done > 0;
    if (found != nullptr) *found = faults_of(*table);
    return ran;
  }

  // What is wrong; empty: nothing.
  static std::string complaint(const Case& c, const Fault& f, const Ran& ran) {
    if (ran.late) return "no end within the limit";
    if (ran.orphans) return "a process is left behind";
    if (!ran.hit) return "";
    const bool fails_too = c.right == 1;
    if (f.error == EINTR && ran.code != c.right) return "an interrupted call changed the exit code";
    if (fails_too && f.judged && ran.code != 1)
      return "a failure that was seen is not the exit code";
    if (ran.code == 1 && !fails_too) return "the host's fault is the firmware's";
    if (ran.code == 1 && !is_told(ran.text)) return "the failure is not told";
    if (ran.code == 0 && fails_too) return "a plan that fails passed";
    if (ran.code == 0 && !whole(ran.results)) return "passed, but results are lost";
    if (ran.code > 4) return "ended by a signal";
    if (ran.code == 4) return "the host's fault is told as whirl's own";
    const bool mendable = f.error == EACCES || f.error == ENOENT;
    if (ran.code == 2 && !mendable) return "the host's fault is told as the user's";
    if (ran.code != 0 && ran.text.size() < 10) return "no words";
    return "";
  }

 private:
  // With its expectation, or, where the report of its process is lost, with its verdict and that.
  static bool is_told(const std::string& text) {
    const bool lost = text.find("FAIL fails\n       its report") != std::string::npos;
    return lost || text.find("it flies high") != std::string::npos;
  }

  void plan(const std::string& name, const std::string& body) const {
    std::ofstream(folder_.file(name + ".lua"))
        << "plan '" << name
        << "' { image = 'flight', vehicle = 'hp_quad', timeout = '5 s', run = function(t)\n"
        << "t:wait '60 ms' " << body << " end }\n";
  }

  [[noreturn]] void become(const Case& c, const std::string& table, const std::string& results,
                           const std::string& output) const {
    const int fd = open(output.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    dup2(fd, 1);
    dup2(fd, 2);
    setpgid(0, 0);
    personality(ADDR_NO_RANDOMIZE);
    setenv(kTableVariable, table.c_str(), 1);
    setenv("LD_PRELOAD", injector_.c_str(), 1);
    std::vector<std::string> words{"whirl", "run", "--out", results};
    if (c.plans.size() > 1) words.insert(words.end(), {"--jobs", "2"});
    for (const std::string& name : c.plans) words.push_back(folder_.file(name + ".lua"));
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    execv(whirl_.c_str(), argv.data());
    _exit(127);
  }

  static void wait_for(pid_t pid, Ran& ran) {
    const auto end = std::chrono::steady_clock::now() + kLongest;
    int status = 0;
    while (waitpid(pid, &status, WNOHANG) == 0) {
      if (std::chrono::steady_clock::now() > end) {
        ran.late = true;
        kill(pid, SIGKILL);
        waitpid(pid, &status, 0);
        break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  // Processes that still carry the table of this run; they get a moment to go, then they are ended.
  static bool left_behind(const std::string& table) {
    const std::string mark = std::string(kTableVariable) + "=" + table;
    for (int tries = 0;; ++tries) {
      std::vector<pid_t> left;
      for (const auto& entry : fs::directory_iterator("/proc")) {
        const std::string name = entry.path().filename();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        const std::string environment = read_file(entry.path() / "environ");
        if ((environment + '\0').find(mark + '\0') != std::string::npos)
          left.push_back(std::stoi(name));
      }
      if (left.empty()) return false;
      if (tries == 40) {
        for (pid_t pid : left) kill(pid, SIGKILL);
        return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }

  static std::vector<int> errors_of(const std::string& call) {
    static const std::map<std::string, std::vector<int>> known{{"open", {EMFILE, EACCES, EINTR}},
                                                               {"fork", {EAGAIN}},
                                                               {"execv", {ENOMEM}},
                                                               {"execvp", {ENOMEM}},
                                                               {"mmap", {ENOMEM}},
                                                               {"memfd_create", {EMFILE}},
                                                               {"waitpid", {EINTR}},
                                                               {"wait", {EINTR}},
                                                               {"mkdir", {ENOSPC}},
                                                               {"mkdtemp", {ENOSPC, EACCES}},
                                                               {"rename", {ENOSPC}},
                                                               {"symlink", {ENOSPC}},
                                                               {"read", {EINTR, EIO}},
                                                               {"close", {EINTR, EIO}},
                                                               {"dup2", {EMFILE}},
                                                               {"popen", {EMFILE}},
                                                               {"fopen", {EMFILE}},
                                                               {"fsync", {EIO}},
                                                               {"fdatasync", {EIO}}};
    const auto found = known.find(call);
    return found != known.end() ? found->second : std::vector<int>{ENOSPC, EINTR};
  }

  static std::vector<Fault> faults_of(const SiteTable& table) {
    std::vector<Fault> all;
    for (const Site& site : table.sites) {
      if (site.hash == 0) continue;
      for (const int error : errors_of(site.call)) {
        const bool judged_first = table.judged > 0 && site.first >= table.judged;
        const bool judged_last = table.judged > 0 && site.last >= table.judged;
        all.push_back({site.hash, 1, error, site.call, judged_first});
        if (site.count > 1) all.push_back({site.hash, site.count, error, site.call, judged_last});
      }
    }
    std::sort(all.begin(), all.end(), [](const Fault& a, const Fault& b) {
      return std::tie(a.site, a.occurrence, a.error) < std::tie(b.site, b.occurrence, b.error);
    });
    return all;
  }

  static bool whole(const std::string& results) {
    std::error_code none;
    for (const auto& run : fs::directory_iterator(fs::path(results) / "runs", none)) {
      if (run.is_symlink() || run.path().filename().string().front() == '.') continue;
      for (const char* name : {"junit.xml", "index.html", "bus.csv", "telemetry.tlog"}) {
        if (!fs::exists(run.path() / name)) return false;
      }
      const std::string json = read_file(run.path() / "run.json");
      const std::string truth = read_file(run.path() / "truth.csv");
      // A row for each of 60 ms, that of the start, and the names above.
      return json.ends_with("}\n") && std::count(truth.begin(), truth.end(), '\n') == 62;
    }
    return false;
  }

  ScratchFolder folder_;
  std::string whirl_, injector_;
  int runs_ = 0;
};

int hold(Driver& driver, const Case& c, std::size_t sample, unsigned seed) {
  std::vector<Fault> faults;
  const Ran plain = driver.run(c, nullptr, &faults);
  if (plain.code != c.right || faults.empty()) {
    std::printf("%s: exit code %d without a fault\n%s", c.name, plain.code, plain.text.c_str());
    return 1;
  }
  const std::size_t all = faults.size();
  std::shuffle(faults.begin(), faults.end(), std::mt19937(seed));
  if (sample > 0 && sample < all) faults.resize(sample);
  int wrong = 0, missed = 0;
  std::map<int, int> codes;
  for (const Fault& fault : faults) {
    const Ran ran = driver.run(c, &fault, nullptr);
    ++codes[ran.code];
    missed += ran.hit ? 0 : 1;
    const std::string what = Driver::complaint(c, fault, ran);
    if (what.empty()) continue;
    ++wrong;
    std::printf("%s, %s fails with %s at occurrence %u (site %016llx): %s (exit code %d)\n%s\n",
                c.name, fault.call.c_str(), strerrorname_np(fault.error), fault.occurrence,
                static_cast<unsigned long long>(fault.site), what.c_str(), ran.code,
                ran.text.c_str());
    std::fflush(stdout);
  }
  std::printf("%s: %zu of %zu faults, %d not reached again, %d wrong; exit codes", c.name,
              faults.size(), all, missed, wrong);
  for (const auto& [code, n] : codes) std::printf(" %d x %d", n, code);
  std::printf("\n");
  std::fflush(stdout);
  return wrong;
}

}  // namespace
}  // namespace whirl::host_faults

int main(int argc, char** argv) {
  using namespace whirl::host_faults;
  if (argc < 3) {
    std::fprintf(stderr, "host_faults WHIRL INJECTOR [--sample N] [--seed S]\n");
    return 2;
  }
  std::size_t sample = 0;
  unsigned seed = 1;
  for (int i = 3; i + 1 < argc; i += 2) {
    const std::string key = argv[i];
    if (key == "--sample") sample = std::strtoul(argv[i + 1], nullptr, 10);
    if (key == "--seed") seed = static_cast<unsigned>(std::strtoul(argv[i + 1], nullptr, 10));
  }
  Driver driver(argv[1], argv[2]);
  int wrong = 0;
  for (const Case& c :
       {Case{"a plan that passes", {"passes"}, 0}, Case{"a plan that fails", {"fails"}, 1},
        Case{"both in two processes", {"passes", "fails"}, 1}}) {
    wrong += hold(driver, c, sample, seed);
  }
  return wrong == 0 ? 0 : 1;
}
