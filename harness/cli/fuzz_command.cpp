#include "harness/cli/fuzz_command.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>

#include "base/argv.hpp"
#include "base/places.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/parser_fuzzers.hpp"
#include "harness/target/fuzz_image.hpp"
#include "harness/target/virtual_board.hpp"
#include "results/verdict.hpp"

namespace whirl::cli {
namespace {

constexpr std::uint64_t kOwn_night = 0;  // seeds not given
constexpr std::uint64_t kImages_per_line = 100;

struct Amount {
  bool smoke;
  std::uint64_t seeds, first;
};

// One line of the table: a function of ours, or the name of a program that lies beside whirl and its
// arguments for that amount. Such a program ends with 0 when it found nothing.
struct Fuzzer {
  const char* name;
  const char* what;
  Result<Done> (*run)(const Amount& amount);
  const char* program;
  std::vector<std::string> (*arguments)(const Amount& amount);
};

Result<Done> fuzz_images(const Amount& amount);
Result<Done> fuzz_parsers(const Amount& amount);
std::vector<std::string> register_arguments(const Amount& amount);

constexpr Fuzzer kFuzzers[] = {
    {"registers", "random register accesses against both chip models", nullptr, "fuzz_registers",
     register_arguments},
    {"images", "register-writing firmware for both parts in QEMU", fuzz_images, nullptr, nullptr},
    {"parsers", "whatever a file or a wire may hold, by libFuzzer", fuzz_parsers, nullptr, nullptr},
};

std::vector<std::string> register_arguments(const Amount& amount) {
  const std::uint64_t seeds = amount.seeds != kOwn_night ? amount.seeds
                              : amount.smoke             ? 5000
                                                         : 1'000'000;
  return {std::to_string(seeds), std::to_string(amount.first)};
}

// A file without a name that another process can read.
class ImageFile {
 public:
  explicit ImageFile(const std::vector<std::uint8_t>& bytes) : file_(std::tmpfile()) {
    if (file_ == nullptr) return;
    const bool whole = std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size();
    if (std::fflush(file_) == 0 && whole) {
      path_ = "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(fileno(file_));
    }
  }
  ~ImageFile() {
    if (file_ != nullptr) std::fclose(file_);
  }
  ImageFile(const ImageFile&) = delete;
  ImageFile& operator=(const ImageFile&) = delete;
  const std::string& path() const { return path_; }  // empty: the disk is full

 private:
  FILE* file_;
  std::string path_;
};

struct Ends {
  std::uint64_t ran = 0, stopped = 0;
};

void print_ends(const Ends& ends) {
  std::printf("  images: %llu ran to their end, %llu were stopped by their own fault\n",
              static_cast<unsigned long long>(ends.ran),
              static_cast<unsigned long long>(ends.stopped));
  std::fflush(stdout);  // who watches a night waits for these lines
}

// Any way in which firmware can end is good.
Result<Done> run_image(std::uint64_t seed, Ends& ends) {
  constexpr std::int64_t kStep_ns = 1'000'000;
  constexpr int kSteps = 20;
  const FuzzImage image = fuzz_image(seed);
  const ImageFile file(image.elf);
  if (file.path().empty()) return Error{ErrorKind::host, "fuzz", "no temporary file", ""};
  VirtualBoardOptions options;
  options.board.board = {.name = "fuzz", .mcu = image.mcu, .hse_Hz = 8e6};
  options.board.run.image = file.path();
  VirtualBoard target(options);
  if (auto started = target.start(); !started) return started.error();
  io::Batch happened;
  TargetState state = TargetState::running;
  for (int k = 1; k <= kSteps && state == TargetState::running; ++k) {
    target.run(k * kStep_ns, {});
    const auto arrived = target.arrive(happened);
    if (!arrived) return arrived.error();
    state = arrived.value();
  }
  ++(state == TargetState::running ? ends.ran : ends.stopped);
  target.stop(happened);
  return Done{};
}

Result<Done> fuzz_images(const Amount& amount) {
  const std::uint64_t seeds = amount.seeds != kOwn_night ? amount.seeds
                              : amount.smoke             ? 12
                                                         : 20'000;
  Ends ends;
  std::string bad;
  for (std::uint64_t done = 0; done < seeds; ++done) {
    if (done > 0 && done % kImages_per_line == 0) print_ends(ends);
    const std::uint64_t seed = amount.first + done;
    const auto good = run_image(seed, ends);
    if (good) continue;
    if (good.error().kind == ErrorKind::host) return good.error();
    std::printf("  images: seed %llu: %s\n", static_cast<unsigned long long>(seed),
                good.error().message().c_str());
    bad += " " + std::to_string(seed);
  }
  print_ends(ends);
  if (bad.empty()) return Done{};
  return Error{ErrorKind::internal, "images", "bad seeds:" + bad,
               "whirl fuzz images --seeds 1 --first SEED"};
}

Result<Done> fuzz_parsers(const Amount& amount) {
  if (!places()) return places().error();
  ParserFuzzOptions options;
  options.root = places().value().root;
  // Less optimized and counting edges only, but there once ./whirl test has built its tests.
  if (amount.smoke) options.build = options.root + "/build/sanitize";
  options.seconds = amount.smoke ? 6.0 : 3600.0;
  options.runs = static_cast<std::int64_t>(amount.seeds);
  options.seed = amount.first + 1;  // libFuzzer takes 0 for "any"
  switch (run_parser_fuzzers(options)) {
    case 0:
      return Done{};
    case 2:
      return Error{ErrorKind::bad_input, "parsers", "could not be run", ""};
    default:
      return Error{ErrorKind::internal, "parsers", "an input was found that breaks one", ""};
  }
}

Result<Done> run_program(const Fuzzer& fuzzer, const Amount& amount) {
  const std::string self = own_program();
  const std::string path = self.substr(0, self.rfind('/') + 1) + fuzzer.program;
  if (access(path.c_str(), X_OK) != 0) {
    return Error{ErrorKind::host, path, "is not there",
                 std::string("build the target ") + fuzzer.program};
  }
  std::vector<std::string> words = fuzzer.arguments(amount);
  words.insert(words.begin(), path);
  std::vector<char*> argv = argv_of(words);
  std::fflush(stdout);
  const pid_t pid = fork();
  if (pid < 0) return Error{ErrorKind::host, path, "cannot start a process", ""};
  if (pid == 0) {
    execv(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  while (waitpid(pid, &status, 0) != pid) {
    if (errno != EINTR) return Error{ErrorKind::host, path, "its end was not told", ""};
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return Done{};
  const bool killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
  const std::string how = WIFSIGNALED(status) ? std::string("signal ") + strsignal(WTERMSIG(status))
                                              : "exit code " + std::to_string(WEXITSTATUS(status));
  return Error{killed ? ErrorKind::host : ErrorKind::internal, fuzzer.name, "ended with " + how,
               ""};
}

bool wanted(const FuzzOptions& options, const char* name) {
  return options.names.empty() ||
         std::find(options.names.begin(), options.names.end(), name) != options.names.end();
}

Result<Done> check_names(const FuzzOptions& options) {
  std::string known;
  for (const Fuzzer& fuzzer : kFuzzers)
    known += (known.empty() ? "" : ", ") + std::string(fuzzer.name);
  for (const std::string& name : options.names) {
    const bool there = std::any_of(std::begin(kFuzzers), std::end(kFuzzers),
                                   [&](const Fuzzer& fuzzer) { return name == fuzzer.name; });
    if (!there) return Error{ErrorKind::bad_input, name, "no such fuzzer", "there are " + known};
  }
  return Done{};
}

}  // namespace

// All are run, whatever the first one finds; a bug of ours outweighs the host's trouble.
int fuzz_command(const FuzzOptions& options) {
  if (const auto good = check_names(options); !good) return complain(good.error());
  const Amount amount{options.smoke, options.seeds, options.first};
  int worst = 0;
  for (const Fuzzer& fuzzer : kFuzzers) {
    if (!wanted(options, fuzzer.name)) continue;
    std::printf("%s: %s\n", fuzzer.name, fuzzer.what);
    const auto found = fuzzer.run != nullptr ? fuzzer.run(amount) : run_program(fuzzer, amount);
    if (!found) worst = results::worse_exit_code(worst, complain(found.error()));
  }
  return worst;
}

}  // namespace whirl::cli
