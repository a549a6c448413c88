// A new folder below the system's place for temporary files, for the tests of what reads and writes
// files. It goes with its owner, so that no test meets what another one, or another checkout, left.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <string>

#include "base/check.hpp"

namespace whirl {

class ScratchFolder {
 public:
  explicit ScratchFolder(
      const std::filesystem::path& below = std::filesystem::temp_directory_path())
      : path_((below / "whirl_test_XXXXXX").string()) {
    WHIRL_CHECK(mkdtemp(path_.data()) != nullptr);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace whirl
