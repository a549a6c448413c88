#include "base/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace whirl {

OutputFile::OutputFile(std::string path) : path_(std::move(path)), out_(path_, std::ios::binary) {}

Result<Done> OutputFile::close() {
  errno = 0;
  out_.close();
  if (out_) return Done{};
  const int why = errno;
  discard();
  return Error{
      ErrorKind::host, path_,
      std::string("cannot be written") + (why != 0 ? std::string(": ") + std::strerror(why) : ""),
      "is the disk full?"};
}

void OutputFile::discard() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

Result<Done> write_text(const std::string& path, const std::string& text) {
  OutputFile out(path);
  out.write(text);
  return out.close();
}

}  // namespace whirl
