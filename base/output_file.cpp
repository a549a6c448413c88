#include "base/output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

namespace whirl {

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
  errno = 0;
  out_.open(part(), std::ios::binary);
  if (!out_) why_not_ = errno;
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      out_(std::move(other.out_)),
      pending_(std::exchange(other.pending_, false)),
      why_not_(other.why_not_) {}

OutputFile::~OutputFile() {
  if (pending_) discard();
}

void OutputFile::write(std::string_view text) {
  if (!out_) return;
  errno = 0;
  out_.write(text.data(), static_cast<std::streamsize>(text.size()));
  if (!out_) why_not_ = errno;
}

Result<Done> OutputFile::close() {
  const bool open = static_cast<bool>(out_);
  errno = 0;
  out_.close();
  if (open && out_ && std::rename(part().c_str(), path_.c_str()) == 0) {
    pending_ = false;
    return Done{};
  }
  if (why_not_ == 0) why_not_ = errno;
  discard();
  const std::string why = why_not_ != 0 ? std::string(": ") + std::strerror(why_not_) : "";
  return Error{ErrorKind::host, path_, "cannot be written" + why,
               why_not_ == 0 || why_not_ == ENOSPC ? "is the disk full?" : ""};
}

void OutputFile::discard() {
  pending_ = false;
  out_.close();
  std::error_code ignored;
  std::filesystem::remove(part(), ignored);
}

Result<Done> write_text(const std::string& path, const std::string& text) {
  OutputFile out(path);
  out.write(text);
  return out.close();
}

}  // namespace whirl
