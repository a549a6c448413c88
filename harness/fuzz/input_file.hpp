// An input of the fuzzer as a file that has a path, without a disk: for readers that want paths.
#pragma once
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <tuple>

#include "base/check.hpp"

namespace whirl::fuzz {

class InputFile {
 public:
  InputFile() : fd_(memfd_create("input", 0)) { WHIRL_CHECK(fd_ >= 0); }
  ~InputFile() { close(fd_); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  void write(const std::uint8_t* data, std::size_t size) const {
    WHIRL_CHECK(ftruncate(fd_, 0) == 0);
    WHIRL_CHECK(pwrite(fd_, data, size, 0) == static_cast<ssize_t>(size), size);
  }
  std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

inline const std::string& path_of(const std::uint8_t* data, std::size_t size) {
  static const InputFile file;
  static const std::string path = file.path();
  file.write(data, size);
  return path;
}

}  // namespace whirl::fuzz
