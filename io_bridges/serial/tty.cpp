#include "io_bridges/serial/tty.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

// The kernel's own header has the free rate (BOTHER); libc's termios.h declares the same names.
#include <asm/termbits.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace whirl::io {
namespace {

constexpr std::size_t kMost_kept_B = 65536;

Error refused(const std::string& path, const std::string& what, const std::string& cure) {
  return {ErrorKind::bad_input, path, what, cure};
}

Error why_not_opened(const std::string& path, int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return refused(path, "no such serial line", "ls /dev/serial/by-id tells what is plugged in");
    case EACCES:
    case EPERM:
      return refused(path, "no permission", "sudo usermod -aG dialout $USER, and log in again");
    case EBUSY:
      return refused(path, "another program holds it", "fuser " + path + " tells which");
    default:
      return refused(path, std::strerror(error), "");
  }
}

// Root may open what is held, and has to ask. Of a pseudo-terminal the mark outlives who was killed with it, as long as its
// other end stands: there only the lock counts, which ends with its holder.
bool is_held(int file) {
  constexpr unsigned kFirst_pseudo = 136, kLast_pseudo = 143;  // admin-guide/devices.txt
  if (flock(file, LOCK_EX | LOCK_NB) != 0) return errno == EWOULDBLOCK;
  struct stat node {};
  int marked = 0;
  if (fstat(file, &node) != 0 || ioctl(file, TIOCGEXCL, &marked) != 0) return false;
  const unsigned major_number = major(node.st_rdev);
  return marked != 0 && (major_number < kFirst_pseudo || major_number > kLast_pseudo);
}

}  // namespace

Result<Tty> Tty::open(const std::string& path, int baud, TtyFrame frame) {
  const int file = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return why_not_opened(path, errno);
  Tty tty(file, path, frame);
  termios2 line{};
  if (ioctl(file, TCGETS2, &line) != 0) return refused(path, "is no serial line", "");
  if (is_held(file)) {
    ::close(std::exchange(tty.file_, -1));  // the mark is not ours to take away
    return why_not_opened(path, EBUSY);
  }
  if (ioctl(file, TIOCEXCL) != 0) return why_not_opened(path, errno);
  if (const auto set = tty.set_baud(baud); !set) return set.error();
  ioctl(file, TCFLSH, TCIOFLUSH);  // what came before us
  return tty;
}

Result<Done> Tty::set_baud(int baud) {
  termios2 line{};
  line.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | (BOTHER << IBSHIFT);
  if (frame_ == TtyFrame::e82) line.c_cflag |= PARENB | CSTOPB;
  line.c_ispeed = line.c_ospeed = static_cast<speed_t>(baud);
  line.c_cc[VMIN] = 1;  // so that an idle line is not ready, and one that hung up reads as ended
  if (ioctl(file_, TCSETS2, &line) != 0) {
    return refused(path_, std::to_string(baud) + " baud: " + std::strerror(errno), "");
  }
  termios2 got{};
  ioctl(file_, TCGETS2, &got);
  const int made = static_cast<int>(got.c_ospeed);
  if (std::abs(made - baud) * 50 <= baud) return Done{};
  return refused(
      path_, std::to_string(baud) + " baud cannot be made, the nearest is " + std::to_string(made),
      "");
}

Tty::Tty(Tty&& other) noexcept
    : file_(std::exchange(other.file_, -1)),
      path_(std::move(other.path_)),
      frame_(other.frame_),
      to_write_(std::move(other.to_write_)) {}

Tty& Tty::operator=(Tty&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(path_, other.path_);
  std::swap(frame_, other.frame_);
  std::swap(to_write_, other.to_write_);
  return *this;
}

Tty::~Tty() {
  if (file_ < 0) return;
  ioctl(file_, TIOCNXCL);
  ::close(file_);
}

Error Tty::unplugged() const {
  return {ErrorKind::host, path_, "the serial line was unplugged", "plug it in and run again"};
}

Result<std::size_t> Tty::read(std::span<std::uint8_t> buffer) {
  const ssize_t got = ::read(file_, buffer.data(), buffer.size());
  if (got > 0) return static_cast<std::size_t>(got);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return std::size_t{0};
  return unplugged();
}

Result<Done> Tty::write(std::span<const std::uint8_t> bytes) {
  if (to_write_.size() + bytes.size() > kMost_kept_B) {
    return Error{ErrorKind::host, path_, "does not take what is written: 64 KiB wait",
                 "is the other end open, and flow control off?"};
  }
  to_write_.insert(to_write_.end(), bytes.begin(), bytes.end());
  return flush();
}

std::size_t Tty::unsent_B() const {
  int held = 0;
  ioctl(file_, TIOCOUTQ, &held);
  return to_write_.size() + static_cast<std::size_t>(held);
}

Result<Done> Tty::flush() {
  if (to_write_.empty()) return Done{};
  const ssize_t gone = ::write(file_, to_write_.data(), to_write_.size());
  if (gone > 0) to_write_.erase(to_write_.begin(), to_write_.begin() + gone);
  if (gone >= 0 || errno == EAGAIN || errno == EINTR) return Done{};
  return unplugged();
}

}  // namespace whirl::io
