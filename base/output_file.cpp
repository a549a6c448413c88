#include "base/output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

namespace whirl {

namespace {

namespace fs = std::filesystem;

bool is_other_than_a_file(const std::string& path) {
  std::error_code unknown;
  const fs::file_status there = fs::status(path, unknown);
  return fs::exists(there) && !fs::is_regular_file(there) && !fs::is_directory(there);
}

// A link to nothing stays what it is called.
std::string behind_links(const std::string& path) {
  std::error_code unknown;
  const fs::path behind = fs::canonical(path, unknown);
  return unknown ? path : behind.string();
}

}  // namespace

OutputFile::OutputFile(std::string path)
    : path_(std::move(path)), file_(behind_links(path_)), direct_(is_other_than_a_file(path_)) {
  errno = 0;
  out_.open(part(), std::ios::binary);
  if (!out_) why_not_ = errno;
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::move(other.file_)),
      direct_(other.direct_),
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
  if (open && out_ && (direct_ || std::rename(part().c_str(), file_.c_str()) == 0)) {
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
  if (direct_) return;
  std::error_code ignored;
  fs::remove(part(), ignored);
}

Result<Done> write_text(const std::string& path, const std::string& text) {
  OutputFile out(path);
  out.write(text);
  return out.close();
}

}  // namespace whirl
