#include "base/places.hpp"

#include <cstdlib>
#include <filesystem>

namespace whirl {
namespace {

namespace fs = std::filesystem;
constexpr const char* kPlugin = "whirl_board.so";

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

bool is_root(const fs::path& folder) {
  return is_there(folder / "test_plans" / "boards") && is_there(folder / "plant" / "data");
}

// The first of these that exists, seen from each folder above the program; empty: none.
template <typename Good>
fs::path look_upwards(const fs::path& program, const std::vector<fs::path>& below, Good good) {
  for (fs::path at = program.parent_path();; at = at.parent_path()) {
    for (const fs::path& path : below) {
      if (good(at / path)) return (at / path).lexically_normal();
    }
    if (at == at.parent_path()) return {};
  }
}

}  // namespace

Result<Places> find_places(const std::string& program, const std::string& wanted_root) {
  Places places;
  const fs::path root = !wanted_root.empty() ? fs::path(wanted_root)
                                             : look_upwards(program, {"share/whirl", ""}, is_root);
  if (root.empty() || !is_root(root)) {
    return Error{ErrorKind::bad_input, wanted_root.empty() ? program : wanted_root,
                 "whirl's own files (test_plans/boards, plant/data) are not near it",
                 "install it with cmake --install, or name the checkout in WHIRL_ROOT"};
  }
  std::string text = root.string();
  while (text.size() > 1 && text.back() == '/') text.pop_back();
  places.root = text;
  places.plugin =
      look_upwards(program,
                   {fs::path("lib/whirl") / kPlugin, fs::path("io_bridges/qemu/plugin") / kPlugin},
                   is_there)
          .string();
  const bool installed = root.filename() == "whirl" && root.parent_path().filename() == "share";
  places.results = installed ? "whirl-results" : text + "/results";
  return places;
}

std::string own_program() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored).string();
}

const Result<Places>& places() {
  static const Result<Places> mine = [] {
    const char* wanted = std::getenv("WHIRL_ROOT");
    return find_places(own_program(), wanted == nullptr ? "" : wanted);
  }();
  return mine;
}

std::vector<std::string> image_folders(const std::string& root) {
  return {root + "/build/firmware", root + "/build/firmware/images", root + "/images"};
}

std::string polar_folder() {
  return places().ok() ? places().value().root + "/plant/data/polars" : "";
}

}  // namespace whirl
