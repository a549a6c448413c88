#include "harness/cli/versions.hpp"

#include <sys/utsname.h>

#include <filesystem>
#include <fstream>

#include "base/digest.hpp"
#include "base/whole_file.hpp"
#include "harness/cli/first_line.hpp"

namespace whirl::cli {
namespace {

// Digests are reproducible per CPU feature set (libm picks variants by it), so the model is told.
std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (!line.starts_with("model name")) continue;
    const auto colon = line.find(": ");
    return colon == std::string::npos ? line : line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

void add_files(Versions& versions, const Versions& files) {
  for (const auto& [role, path] : files) {
    const auto text = read_whole_file(path);
    if (!text) continue;
    Digest digest;
    digest.add_bytes(text.value().data(), text.value().size());
    versions.emplace_back(
        role, std::filesystem::path(path).filename().string() + " fnv1a64:" + digest.hex());
  }
}

void add_host(Versions& versions, const std::string& root) {
  const std::string commit =
      first_line("git -C '" + root + "' describe --always --dirty --abbrev=12");
  versions.emplace_back(
      "whirl", std::string(WHIRL_VERSION) + (commit.empty() ? "" : ", sources at " + commit));
  versions.emplace_back("host compiler", "gcc " __VERSION__);
  versions.emplace_back("host CPU", cpu_model());
  utsname name{};
  if (uname(&name) == 0) versions.emplace_back("host kernel", name.release);
}

}  // namespace whirl::cli
