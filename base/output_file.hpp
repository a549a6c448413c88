// A file that is written whole or not at all.
#pragma once
#include <fstream>
#include <string>
#include <string_view>

#include "base/result.hpp"

namespace whirl {

class OutputFile {
 public:
  explicit OutputFile(std::string path);

  void write(std::string_view text) {
    out_.write(text.data(), static_cast<std::streamsize>(text.size()));
  }
  // Errors  host: it could not be written whole; nothing of it remains
  Result<Done> close();
  void discard();  // instead: it is not wanted after all
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::ofstream out_;
};

// Nothing is left of a file that could not be written whole.
Result<Done> write_text(const std::string& path, const std::string& text);

}  // namespace whirl
