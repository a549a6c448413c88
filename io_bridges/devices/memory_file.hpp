// The contents of a memory part: bytes in a file of the host, with holes where nothing was written.
//
//   Lasts   each write goes to the file at once: whatever ends the process, the file holds what the
//           part held. Without a path the bytes live as long as the process
//   Host    a file that cannot be read or written any more (a full disk) throws std::system_error, which
//           ends the run as the host's lack
//   Errors  host: the file cannot be made; bad_input: the file to start from cannot be read, or is
//           larger than the part
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "base/result.hpp"

namespace whirl::io {

class MemoryFile {
 public:
  // Of that size, all zero. A file that is there is replaced.
  static Result<MemoryFile> create(const std::string& path, std::int64_t size_bytes);
  ~MemoryFile();
  MemoryFile(MemoryFile&& other) noexcept;
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  // Takes over what another file holds, from the part's first byte on; its holes stay holes.
  Result<Done> copy_from(const std::string& path);

  std::int64_t size_bytes() const { return size_bytes_; }
  void read(std::int64_t at, std::span<std::uint8_t> into) const;
  void write(std::int64_t at, std::span<const std::uint8_t> bytes);
  void clear(std::int64_t at, std::int64_t bytes);  // to zero; makes a hole

 private:
  MemoryFile(int fd, std::int64_t size_bytes) : fd_(fd), size_bytes_(size_bytes) {}
  int fd_;
  std::int64_t size_bytes_;
};

// The size of a file, or what is wrong with it.
Result<std::int64_t> file_size_bytes(const std::string& path);

}  // namespace whirl::io
