// A serial line that this program plays: whoever opens path() is at its other end.
//
//   Line   raw, as a wire is; any rate is as good as another, and bytes come whole: what copper would make of two that
//          differ is left to the player, who may ask for baud()
//   Open   nobody at the other end: what is written is lost, as on a wire, and nothing is read
//   Link   a name of the user's own may point at it; an old one that dangles is replaced
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "base/result.hpp"

namespace whirl::io {

class PseudoTerminal {
 public:
  // link: where a symbolic link to it shall stand; empty: none.
  // Errors  bad_input: the link's place is taken by something else
  static Result<PseudoTerminal> open(const std::string& link = {});
  PseudoTerminal(PseudoTerminal&& other) noexcept;
  PseudoTerminal& operator=(PseudoTerminal&& other) noexcept;
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;
  ~PseudoTerminal();

  std::size_t read(std::span<std::uint8_t> buffer);  // 0: nothing now
  void write(std::span<const std::uint8_t> bytes);   // what does not go is lost, and counted
  std::uint64_t lost_B() const { return lost_B_; }
  bool someone_there() const;
  double baud() const;                               // to which its other end is set
  const std::string& path() const { return path_; }  // "/dev/pts/7"
  int file() const { return file_; }

 private:
  PseudoTerminal(int file, std::string path) : file_(file), path_(std::move(path)) {}
  int file_ = -1;
  std::string path_, link_;
  std::uint64_t lost_B_ = 0;
};

}  // namespace whirl::io
