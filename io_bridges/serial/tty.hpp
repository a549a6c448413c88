// A serial line of this host: /dev/ttyUSB0, /dev/ttyACM0, or the end of a pseudo-terminal.
//
//   Line    raw 8N1, or 8E2 as SBUS is, no flow control; any rate that the driver can make, checked to 2 %
//   Sole    nobody else may open it while it is held (TIOCEXCL, and a lock of the file, which tells root as well)
//   Never   waits: what the kernel does not take now is kept and goes with the next write or flush
//   Errors  bad_input: not there, no permission, no serial line, held by another, the rate cannot be made;
//           host: it was unplugged
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl::io {

enum class TtyFrame : std::uint8_t { n81, e82 };  // parity and stop bits, of eight bits

class Tty {
 public:
  static Result<Tty> open(const std::string& path, int baud, TtyFrame frame = TtyFrame::n81);
  Tty(Tty&& other) noexcept;
  Tty& operator=(Tty&& other) noexcept;
  Tty(const Tty&) = delete;
  Tty& operator=(const Tty&) = delete;
  ~Tty();

  // Reads what has come, up to the buffer's size. 0: nothing now.
  Result<std::size_t> read(std::span<std::uint8_t> buffer);
  Result<Done> write(std::span<const std::uint8_t> bytes);
  Result<Done> flush();  // what was kept
  std::size_t kept_B() const { return to_write_.size(); }
  std::size_t unsent_B()
      const;  // kept here, or by the kernel; what an adapter holds it does not say
  Result<Done> set_baud(int baud);
  int file() const { return file_; }  // to poll
  const std::string& path() const { return path_; }

 private:
  Tty(int file, std::string path, TtyFrame frame)
      : file_(file), path_(std::move(path)), frame_(frame) {}
  Error unplugged() const;
  int file_ = -1;
  std::string path_;
  TtyFrame frame_;
  std::vector<std::uint8_t> to_write_;
};

}  // namespace whirl::io
