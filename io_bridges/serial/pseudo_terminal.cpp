#include "io_bridges/serial/pseudo_terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

namespace whirl::io {
namespace {

namespace fs = std::filesystem;

// Whatever stands there of the user's is left alone; a link to a terminal that has gone is ours to replace.
Result<Done> place_link(const std::string& link, const std::string& target) {
  std::error_code error;
  const auto status = fs::symlink_status(link, error);
  if (fs::exists(status)) {
    if (!fs::is_symlink(status) || fs::exists(link, error)) {
      return Error{ErrorKind::bad_input, link, "is there already", "name another place"};
    }
    fs::remove(link, error);
  }
  fs::create_symlink(target, link, error);
  if (!error) return Done{};
  return Error{ErrorKind::bad_input, link, error.message(), ""};
}

}  // namespace

Result<PseudoTerminal> PseudoTerminal::open(const std::string& link) {
  const int file = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return Error{ErrorKind::host, "/dev/ptmx", std::strerror(errno), ""};
  PseudoTerminal terminal(file, "");
  char path[64];
  termios line{};
  if (::grantpt(file) != 0 || ::unlockpt(file) != 0 || ::ptsname_r(file, path, sizeof path) != 0 ||
      ::tcgetattr(file, &line) != 0) {
    return Error{ErrorKind::host, "/dev/ptmx", std::strerror(errno), ""};
  }
  terminal.path_ = path;
  ::cfmakeraw(&line);  // before anybody opens it: no echo of the first bytes
  ::tcsetattr(file, TCSANOW, &line);
  if (!link.empty()) {
    if (const auto placed = place_link(link, path); !placed) return placed.error();
    terminal.link_ = link;
  }
  return terminal;
}

PseudoTerminal::PseudoTerminal(PseudoTerminal&& other) noexcept
    : file_(std::exchange(other.file_, -1)),
      path_(std::move(other.path_)),
      link_(std::exchange(other.link_, {})),
      lost_B_(other.lost_B_) {}

PseudoTerminal& PseudoTerminal::operator=(PseudoTerminal&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(path_, other.path_);
  std::swap(link_, other.link_);
  std::swap(lost_B_, other.lost_B_);
  return *this;
}

PseudoTerminal::~PseudoTerminal() {
  if (file_ < 0) return;
  ::close(file_);
  std::error_code error;
  if (!link_.empty()) fs::remove(link_, error);
}

bool PseudoTerminal::someone_there() const {
  pollfd one{file_, POLLIN, 0};
  return ::poll(&one, 1, 0) >= 0 && (one.revents & POLLHUP) == 0;
}

std::size_t PseudoTerminal::read(std::span<std::uint8_t> buffer) {
  const ssize_t got = ::read(file_, buffer.data(), buffer.size());
  return got > 0 ? static_cast<std::size_t>(got) : 0;  // EIO: nobody has it open
}

void PseudoTerminal::write(std::span<const std::uint8_t> bytes) {
  // The kernel would keep them for who opens it later: on a wire they are gone.
  const ssize_t gone = someone_there() ? ::write(file_, bytes.data(), bytes.size()) : 0;
  lost_B_ += bytes.size() - static_cast<std::size_t>(gone > 0 ? gone : 0);
}

}  // namespace whirl::io
