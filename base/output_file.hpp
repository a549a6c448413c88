// A file that is written whole or not at all: as NAME.part until it is closed. What bore the name before
// stays until then; who never closes it leaves nothing. A link leads to its file. What is no plain file, a device or a
// FIFO, is written as it stands: no file takes its place.
#pragma once
#include <fstream>
#include <string>
#include <string_view>

#include "base/result.hpp"

namespace whirl {

class OutputFile {
 public:
  explicit OutputFile(std::string path);
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;

  void write(std::string_view text);
  // Errors  host: it could not be written whole; nothing of it remains
  Result<Done> close();
  const std::string& path() const { return path_; }

 private:
  std::string part() const { return direct_ ? path_ : file_ + ".part"; }
  void discard();

  std::string path_, file_;  // as it was said, and where links lead
  bool direct_ = false;      // no plain file
  std::ofstream out_;
  bool pending_ = true;  // neither closed nor discarded
  int why_not_ = 0;      // errno of what failed first
};

// Nothing is left of a file that could not be written whole.
Result<Done> write_text(const std::string& path, const std::string& text);

}  // namespace whirl
