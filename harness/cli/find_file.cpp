#include "harness/cli/find_file.hpp"

#include <filesystem>

namespace whirl::cli {

namespace fs = std::filesystem;

Result<std::string> find_file(const std::string& written, const Asker& who,
                              const std::vector<std::string>& folders,
                              const std::string& extension) {
  std::vector<std::string> tried;
  if (written.find('/') != std::string::npos || fs::path(written).has_extension()) {
    tried = {(fs::path(who.file).parent_path() / written).string(), written};
  } else {
    for (const std::string& folder : folders) tried.push_back(folder + "/" + written + extension);
  }
  for (const std::string& path : tried) {
    std::error_code status;  // a name too long, a link to itself: it is not there
    if (!fs::is_regular_file(path, status)) continue;
    const fs::path whole = fs::weakly_canonical(path, status);
    return status ? path : whole.string();
  }
  return Error{ErrorKind::bad_input, who.place, "'" + written + "' is not there",
               "looked for " + fs::path(tried.front()).lexically_normal().string()};
}

}  // namespace whirl::cli
