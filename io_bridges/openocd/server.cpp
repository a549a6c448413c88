#include "io_bridges/openocd/server.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <sstream>
#include <thread>

#include "base/argv.hpp"

namespace whirl::openocd {
namespace {

constexpr auto kLook_every = std::chrono::milliseconds(20);

// One that is free now; openocd takes it a moment later.
std::uint16_t free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof where;
  std::uint16_t port = 0;
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&where), sizeof where) == 0 &&
      ::getsockname(socket, reinterpret_cast<sockaddr*>(&where), &size) == 0) {
    port = ntohs(where.sin_port);
  }
  ::close(socket);
  return port;
}

std::vector<std::string> command_line(const ServerOptions& options, std::uint16_t port) {
  std::vector<std::string> line{options.program};
  for (const std::string& file : options.files) line.insert(line.end(), {"-f", file});
  for (const std::string& command : options.commands) line.insert(line.end(), {"-c", command});
  for (const char* quiet : {"gdb_port disabled", "telnet_port disabled", "bindto 127.0.0.1"}) {
    line.insert(line.end(), {"-c", quiet});
  }
  line.insert(line.end(), {"-c", "tcl_port " + std::to_string(port), "-c", "init"});
  return line;
}

std::string all_of(int fd) {
  std::string text;
  std::array<char, 4096> piece;
  off_t at = 0;
  for (ssize_t n = 0; (n = ::pread(fd, piece.data(), piece.size(), at)) > 0; at += n) {
    text.append(piece.data(), static_cast<std::size_t>(n));
  }
  return text;
}

}  // namespace

Error complaint_of(const std::string& said) {
  std::string first;  // of its errors
  std::istringstream lines(said);
  for (std::string line; std::getline(lines, line);) {
    const auto at = line.find("Error: ");
    if (at == std::string::npos || !first.empty()) continue;
    first = line.substr(at + 7);
  }
  const auto has = [&](const char* word) { return said.find(word) != std::string::npos; };
  const auto error = [&](const std::string& what, const std::string& cure) {
    return Error{ErrorKind::bad_input, "openocd", what + (first.empty() ? "" : ": " + first), cure};
  };
  if (has("LIBUSB_ERROR_ACCESS") || has("Permission denied") || has("insufficient permissions")) {
    return error("the probe may not be opened",
                 "Debian's openocd brings udev rules; the user belongs into group plugdev");
  }
  if (has("LIBUSB_ERROR_BUSY") || has("already in use")) {
    return error("the probe is busy", "who else has it? another openocd, an IDE?");
  }
  if (has("open failed") || has("unable to find a matching") || has("no device found") ||
      has("No J-Link device found") || has("unable to open ftdi") || has("Error: unable to find")) {
    return error("no probe is there",
                 "is it plugged in? probe = { interface = ... } of the bench file?");
  }
  if (has("Can't find") && has(".cfg")) {
    return error("a configuration is not there",
                 "those of Debian's openocd are in /usr/share/openocd/scripts");
  }
  if (has("init mode failed") || has("unable to connect to the target") ||
      has("target not examined") || has("Examination failed") || has("cannot read IDR") ||
      has("DAP transaction stalled")) {
    return error("no target answers behind the probe",
                 "is the board powered, SWDIO, SWCLK and GND wired?");
  }
  return error("did not start", "");
}

Result<std::unique_ptr<Server>> Server::start(const ServerOptions& options) {
  std::unique_ptr<Server> server(new Server);
  const std::uint16_t port = free_port();
  std::vector<std::string> line = command_line(options, port);
  const int log = ::memfd_create("openocd", MFD_CLOEXEC);
  if (port == 0 || log < 0) return Error{ErrorKind::host, "openocd", "no port or memory", ""};
  ::fcntl(log, F_SETFL, O_APPEND);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, log, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, log, STDERR_FILENO);
  const int failed = ::posix_spawnp(&server->pid_, options.program.c_str(), &files, nullptr,
                                    argv_of(line).data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (failed != 0) {
    ::close(log);
    server->pid_ = -1;
    return Error{ErrorKind::bad_input, options.program,
                 std::string("cannot be started: ") + std::strerror(failed),
                 "apt-get install openocd"};
  }
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::milliseconds(options.start_timeout_ms);
  while (std::chrono::steady_clock::now() < end) {
    if (::waitpid(server->pid_, nullptr, WNOHANG) == server->pid_) {
      server->pid_ = -1;
      break;
    }
    auto client = TclClient::connect(port, 1000);
    if (client) {
      server->client_ = std::move(client.value());
      ::close(log);
      return server;
    }
    std::this_thread::sleep_for(kLook_every);
  }
  const std::string said = all_of(log);
  ::close(log);
  return complaint_of(said);
}

Server::~Server() {
  if (pid_ <= 0) return;
  if (client_) std::ignore = client_->ask("shutdown", 1000);
  client_.reset();
  for (int i = 0; i < 50; ++i) {
    if (::waitpid(pid_, nullptr, WNOHANG) == pid_) return;
    std::this_thread::sleep_for(kLook_every);
  }
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

}  // namespace whirl::openocd
