#include "base/whole_file.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace whirl {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargest_file_B = 64u << 20;

}  // namespace

Result<std::string> read_whole_file(const std::string& path) {
  std::error_code status;
  const fs::file_status file = fs::status(path, status);
  const auto refused = [&](const char* what) {
    return Error{ErrorKind::bad_input, path, what, ""};
  };
  if (fs::is_directory(file)) return refused("is a folder, not a file");
  if (fs::exists(file) && !fs::is_regular_file(file)) return refused("is no plain file");
  if (fs::exists(file) && fs::file_size(path, status) > kLargest_file_B) {
    return refused("is larger than 64 MiB");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) return refused("no such file, or not readable");
  const std::uintmax_t size = fs::file_size(path, status);
  std::string text(status ? 0 : static_cast<std::size_t>(size), '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) return Error{ErrorKind::host, path, "cannot be read to its end", ""};
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in) text.append(std::istreambuf_iterator<char>(in), {});  // what has no size, or has grown
  return text;
}

}  // namespace whirl
