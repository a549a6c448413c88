// A nameless file in memory between two processes: no pipe that could fill up, no folder needed.
#pragma once
#include <string>
#include <string_view>

namespace whirl::cli {

// Whole, from the start; false: errno says why. An interrupted call goes on.
bool read_whole(int fd, std::string& text);
bool write_whole(int fd, std::string_view text);

class MemoryFile {
 public:
  explicit MemoryFile(const char* name);  // is_open() tells; errno says why not
  ~MemoryFile();
  MemoryFile(MemoryFile&& other) noexcept;
  MemoryFile& operator=(MemoryFile&& other) noexcept;

  bool is_open() const { return fd_ >= 0; }
  int fd() const { return fd_; }

 private:
  int fd_ = -1;
};

}  // namespace whirl::cli
