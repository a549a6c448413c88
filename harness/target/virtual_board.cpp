#include "harness/target/virtual_board.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>

#include "base/interruption.hpp"
#include "base/outside_signal.hpp"
#include "base/places.hpp"
#include "io_bridges/board_description/board_text.hpp"
#include "io_bridges/link/channel.hpp"
#include "io_bridges/qemu/board/parts.hpp"

namespace whirl {
namespace {

constexpr int kSlice_ms = 100;        // how soon the death of QEMU is noticed
constexpr int kLast_words = 12;       // lines of output that an error repeats
constexpr int kFarewell_ms = 10000;   // for the statistics at the end
constexpr double kLeast_share = 0.5;  // of the silence, in which a healthy host lets QEMU compute
constexpr int kNot_started = 127;     // our child's exit code when there is nothing to run

// A signal may interrupt it, or let it write a part.
bool write_all(int fd, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = write(fd, text.data() + at, text.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += static_cast<std::size_t>(n);
  }
  return true;
}

int text_in_memory(const char* name, const std::string& text) {
  const int fd = memfd_create(name, MFD_CLOEXEC);
  if (fd < 0 || write_all(fd, text)) return fd;
  close(fd);
  return -1;
}

std::string last_lines(const std::string& text, int lines) {
  std::size_t from = text.size();
  while (from > 0 && lines > 0) {
    from = text.rfind('\n', from - 1);
    if (from == std::string::npos) return text;
    if (from + 1 < text.size()) --lines;
  }
  return text.substr(from == 0 ? 0 : from + 1);
}

// QEMU has gone without a word through the link: whose doing was it?
Error why_it_ended(int status, const std::string& qemu, const std::string& words) {
  const auto said = [&](const char* text) { return words.find(text) != std::string::npos; };
  const std::string tail = "; its last words:\n" + last_lines(words, kLast_words);
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    const std::string what = std::string("QEMU was ended by signal ") + strsignal(signal) + tail;
    if (!is_from_outside(signal)) return {ErrorKind::internal, "virtual board", what, ""};
    return {ErrorKind::host, "virtual board", what,
            "did somebody end it, or the kernel for want of memory?"};
  }
  const int code = WEXITSTATUS(status);
  if (code == kNot_started) {
    return {ErrorKind::host, qemu, "cannot be started" + tail, "apt-get install qemu-system-arm"};
  }
  const std::string what = "QEMU ended with exit code " + std::to_string(code) + tail;
  if (said("Failed to find an available port") || said("Address already in use")) {
    return {ErrorKind::bad_input, "--gdb", "the port is in use" + tail, "end what listens there"};
  }
  const bool host = said("terminating on signal") || said("Cannot allocate memory") ||
                    said("Too many open files") || said("Resource temporarily unavailable");
  return {host ? ErrorKind::host : ErrorKind::internal, "virtual board", what, ""};
}

// Of /proc/PID/stat: the state's letter, and the CPU time that the process has used.
struct Activity {
  char state = '?';
  double cpu_s = 0.0;
};
Activity activity_of(pid_t pid) {
  Activity activity;
  FILE* file = std::fopen(("/proc/" + std::to_string(pid) + "/stat").c_str(), "r");
  if (file == nullptr) return activity;
  unsigned long user = 0, system = 0;
  const int got =
      std::fscanf(file, "%*d (%*[^)]) %c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu",
                  &activity.state, &user, &system);
  std::fclose(file);
  if (got == 3) {
    activity.cpu_s = static_cast<double>(user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  }
  return activity;
}

// The few facts of the board's description that the command line of QEMU needs.
struct Launch {
  std::string machine;
  int icount_shift = 0;
  int gdb_port = 0;
};

Result<Launch> launch_of(const BoardStart& start) {
  const board::Part* part = board::find_part(start.board.mcu);
  if (part == nullptr) {
    return Error{ErrorKind::bad_input, start.board.file.empty() ? "board" : start.board.file,
                 "unknown mcu '" + start.board.mcu + "'", "use stm32f405rg or stm32f103cb"};
  }
  const std::int64_t ns = start.board.ns_per_instruction;
  Launch launch{std::string(part->qemu_machine), 0, start.run.gdb_port};
  if (ns == 0) return launch;  // by cycles: QEMU counts nanoseconds
  while (launch.icount_shift < 10 && (1 << launch.icount_shift) != ns) ++launch.icount_shift;
  if (launch.icount_shift == 10) {
    return Error{ErrorKind::bad_input, "board",
                 "ns_per_instruction " + std::to_string(ns) + " is not a power of two below 1024",
                 "use 8"};
  }
  return launch;
}

}  // namespace

struct VirtualBoard::Process {
  explicit Process(io::Channel channel) : link(std::move(channel)) {}
  ~Process() {
    end();
    if (log_fd >= 0) close(log_fd);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  bool gone() {  // reaps
    if (pid == 0) return true;
    if (waitpid(pid, &status, WNOHANG) != pid) return false;
    pid = 0;
    return true;
  }
  void end() {
    if (pid == 0) return;
    kill(pid, SIGKILL);
    waitpid(pid, &status, 0);
    pid = 0;
  }

  io::Channel link;
  pid_t pid = 0;
  int status = 0;
  int log_fd = -1;
  bool watch_silence = true;
  std::int64_t until_ns = 0;
};

VirtualBoard::VirtualBoard(VirtualBoardOptions options) : options_(std::move(options)) {
  if (options_.plugin.empty()) options_.plugin = default_plugin();
}

VirtualBoard::~VirtualBoard() = default;

int VirtualBoard::pid() const {
  return process_ ? process_->pid : 0;
}

std::string VirtualBoard::output() const {
  if (!process_ || process_->log_fd < 0) return "";
  struct stat status {};
  if (fstat(process_->log_fd, &status) != 0) return "";
  constexpr off_t kTail = 8192;
  std::string text(static_cast<std::size_t>(std::min(status.st_size, kTail)), '\0');
  const ssize_t got = pread(process_->log_fd, text.data(), text.size(),
                            status.st_size - static_cast<off_t>(text.size()));
  text.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
  return text;
}

namespace {

std::vector<std::string> command_line(const VirtualBoardOptions& options, const Launch& launch,
                                      int link_fd, int config_fd) {
  std::vector<std::string> line = {
      options.qemu,
      "-M",
      launch.machine,
      "-nodefaults",
      "-display",
      "none",
      "-serial",
      "none",
      "-monitor",
      "none",
      "-icount",
      "shift=" + std::to_string(launch.icount_shift) + ",sleep=off,align=off",
      "-plugin",
      options.plugin + ",link=" + std::to_string(link_fd) + ",config=" + std::to_string(config_fd) +
          (options.any_qemu_version ? ",any_qemu=on" : "")};
  if (launch.gdb_port != 0) {
    line.insert(line.end(), {"-gdb", "tcp:127.0.0.1:" + std::to_string(launch.gdb_port), "-S"});
  }
  line.insert(line.end(), options.qemu_options.begin(), options.qemu_options.end());
  return line;
}

// Lets only the given descriptors through to QEMU.
pid_t launch_process(const std::vector<std::string>& line, int log_fd,
                     const std::vector<int>& passed) {
  std::vector<char*> argv;
  argv.reserve(line.size() + 1);
  for (const std::string& word : line) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid != 0) return pid;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setpgid(0, 0);  // a terminal's interrupt is the harness's to act on
  if (getppid() != parent) _exit(kNot_started);  // it died before we asked
  const int null = open("/dev/null", O_RDONLY);
  for (const int fd : passed) fcntl(fd, F_SETFD, 0);
  dup2(null, 0);
  dup2(log_fd, 1);
  dup2(log_fd, 2);
  execvp(argv[0], argv.data());
  dprintf(2, "%s: %s\n", argv[0], strerror(errno));
  _exit(kNot_started);
}

}  // namespace

Result<Done> VirtualBoard::start() {
  auto launch = launch_of(options_.board);
  if (!launch) return launch.error();
  if (access(options_.plugin.c_str(), R_OK) != 0) {
    return Error{ErrorKind::internal, options_.plugin, "the board's plug-in is not there",
                 "build the target whirl_board"};
  }
  auto link = io::Channel::create(io::Side::harness);
  if (!link) return link.error();
  process_ = std::make_unique<Process>(std::move(link.value()));
  const int config_fd = text_in_memory("whirl-board", board_text(options_.board));
  process_->log_fd = memfd_create("whirl-qemu-output", MFD_CLOEXEC);
  if (config_fd < 0 || process_->log_fd < 0) {
    return Error{ErrorKind::host, "virtual board", "no shared memory", ""};
  }
  fcntl(process_->log_fd, F_SETFL, O_APPEND);
  process_->watch_silence = launch.value().gdb_port == 0 && options_.silence_s > 0;
  std::vector<int> passed = {process_->link.fd(), config_fd};
  for (const WireEnd& wire : options_.board.run.wires) passed.push_back(wire.fd);
  process_->pid =
      launch_process(command_line(options_, launch.value(), process_->link.fd(), config_fd),
                     process_->log_fd, passed);
  close(config_fd);
  if (process_->pid < 0) {
    process_->pid = 0;
    return Error{ErrorKind::host, options_.qemu, "cannot start a process", ""};
  }
  auto arrived = await(at_start_);  // it reports at t = 0 that it stands
  if (!arrived) return arrived.error();
  return Done{};
}

void VirtualBoard::run(std::int64_t until_ns, const io::Batch& sensed) {
  WHIRL_CHECK(process_ != nullptr);
  process_->until_ns = until_ns;
  cpu_s_.reset();
  posted_ = process_->link.post(until_ns, sensed.bytes());
}

Result<TargetState> VirtualBoard::arrive(io::Batch& happened) {
  auto arrived = await(happened);
  if (!arrived || at_start_.empty()) return arrived;
  at_start_.add(happened);
  happened = std::exchange(at_start_, {});
  return arrived;
}

Result<TargetState> VirtualBoard::await(io::Batch& happened) {
  happened.clear();
  if (!posted_) return posted_.error();
  if (process_->link.wait(kSlice_ms)) return delivered(happened);
  const auto from = std::chrono::steady_clock::now();
  const double cpu_s = activity_of(process_->pid).cpu_s;
  while (!process_->link.wait(kSlice_ms)) {
    // Dead, and nothing came in the moment before: the order of the two questions matters.
    if (process_->gone() && !process_->link.wait(0)) {
      return why_it_ended(process_->status, options_.qemu, output());
    }
    if (company_) {
      if (auto other = company_(false)) return *other;
    }
    if (interrupted_by() != 0) {
      return Error{ErrorKind::host, "virtual board", "interrupted while it waited", ""};
    }
    const auto silent = std::chrono::steady_clock::now() - from;
    if (process_->watch_silence && silent > std::chrono::seconds(options_.silence_s)) {
      const auto other = company_ ? company_(true) : std::nullopt;
      return other ? *other : give_up(cpu_s);
    }
  }
  return delivered(happened);
}

bool VirtualBoard::over() const {
  return process_ && process_->link.arrived() && process_->link.state() != io::BoardState::running;
}

std::optional<Error> VirtualBoard::died() {
  if (!process_ || process_->pid == 0) return {};
  if (!cpu_s_) cpu_s_ = activity_of(process_->pid).cpu_s;
  if (!process_->gone() || process_->link.arrived()) return {};
  return why_it_ended(process_->status, options_.qemu, output());
}

std::optional<Error> VirtualBoard::hangs() {
  if (!process_ || process_->pid == 0 || process_->link.arrived()) return {};
  return give_up(cpu_s_.value_or(0.0));
}

// A QEMU that computes without end is our bug; one that hardly got to compute is the host's.
Error VirtualBoard::give_up(double cpu_s_before) {
  const Activity activity = activity_of(process_->pid);
  process_->end();
  const std::string what = "no answer for " + std::to_string(options_.silence_s) +
                           " s of host time at virtual " + std::to_string(process_->until_ns) +
                           " ns; its last words:\n" + last_lines(output(), kLast_words);
  if (activity.state == 'T' || activity.state == 't') {
    return {ErrorKind::host, "virtual board", "QEMU was stopped by a signal or a debugger: " + what,
            ""};
  }
  const double used_s = activity.cpu_s - cpu_s_before;
  if (used_s < kLeast_share * options_.silence_s) {
    return {ErrorKind::host, "virtual board",
            "QEMU got " + std::to_string(used_s) + " s of a processor: " + what,
            "is the machine overloaded?"};
  }
  return {ErrorKind::internal, "virtual board", what, ""};
}

Result<TargetState> VirtualBoard::delivered(io::Batch& happened) const {
  const io::Delivery delivery = process_->link.received();
  const io::BoardState state = process_->link.state();
  if (state == io::BoardState::failed) return process_->link.failure();
  happened.assign(delivery.bytes);
  if (state == io::BoardState::cpu_locked) return TargetState::cpu_locked;
  return state == io::BoardState::ended ? TargetState::ended : TargetState::running;
}

void VirtualBoard::stop(io::Batch& happened) {
  happened.clear();
  if (!process_ || process_->pid == 0) return;
  const io::BoardState state = process_->link.state();
  if (state == io::BoardState::running) {
    io::Batch last;
    last.add(io::Kind::end_of_run, 0, process_->until_ns, nullptr, 0);
    posted_ = process_->link.post(process_->until_ns, last.bytes());
    const bool came = process_->link.wait(process_->gone() ? 0 : kFarewell_ms);
    if (came) happened.assign(process_->link.received().bytes);
  }
  process_->end();
}

std::vector<std::pair<std::string, std::string>> VirtualBoard::versions() const {
  std::vector<std::pair<std::string, std::string>> list;
  if (!process_) return list;
  const std::string text = process_->link.hello();
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t tab = text.find('\t', at), end = text.find('\n', at);
    if (tab == std::string::npos || end == std::string::npos || tab > end) break;
    list.emplace_back(text.substr(at, tab - at), text.substr(tab + 1, end - tab - 1));
    at = end + 1;
  }
  return list;
}

Result<std::string> probe_qemu(const std::string& qemu) {
  FILE* pipe = popen(("'" + qemu + "' --version 2>&1").c_str(), "r");
  if (pipe == nullptr) return Error{ErrorKind::host, qemu, "cannot be asked for its version", ""};
  char line[256] = "";
  if (fgets(line, sizeof line, pipe) == nullptr) line[0] = '\0';
  const int status = pclose(pipe);
  std::string text(line);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  if (status != 0) {
    return Error{ErrorKind::host, qemu, "not found or not running: " + text,
                 "apt-get install qemu-system-arm"};
  }
  return text;
}

std::string default_plugin() {
  return places().ok() ? places().value().plugin : "";
}

}  // namespace whirl
