#include "io_bridges/devices/memory_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "base/check.hpp"

namespace whirl::io {
namespace {

Error refuse(ErrorKind kind, const std::string& path, const std::string& what) {
  return {kind, path, what, ""};
}

// Of the host: its disk is full, say. Less than was asked for sets no errno.
[[noreturn]] void fail(const char* what, ssize_t moved) {
  throw std::system_error(moved < 0 ? errno : ENOSPC, std::generic_category(),
                          std::string("what a part's memory holds cannot be ") + what);
}

}  // namespace

Result<std::int64_t> file_size_bytes(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    return refuse(ErrorKind::bad_input, path, std::string("cannot be read: ") + strerror(errno));
  }
  if (!S_ISREG(status.st_mode)) return refuse(ErrorKind::bad_input, path, "is no file");
  return static_cast<std::int64_t>(status.st_size);
}

Result<MemoryFile> MemoryFile::create(const std::string& path, std::int64_t size_bytes) {
  WHIRL_CHECK(size_bytes > 0, size_bytes);
  const int fd = path.empty() ? memfd_create("whirl-memory", MFD_CLOEXEC)
                              : open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) {
    return refuse(ErrorKind::host, path.empty() ? "memory of a part" : path,
                  std::string("cannot be made: ") + strerror(errno));
  }
  MemoryFile file(fd, size_bytes);
  if (ftruncate(fd, size_bytes) == 0) return file;
  return refuse(ErrorKind::host, path, std::string("cannot be made so large: ") + strerror(errno));
}

MemoryFile::MemoryFile(MemoryFile&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), size_bytes_(other.size_bytes_) {}

MemoryFile::~MemoryFile() {
  if (fd_ >= 0) close(fd_);
}

Result<Done> MemoryFile::copy_from(const std::string& path) {
  const auto size = file_size_bytes(path);
  if (!size) return size.error();
  if (size.value() > size_bytes_) {
    return refuse(
        ErrorKind::bad_input, path,
        "has " + std::to_string(size.value()) + " bytes, the part " + std::to_string(size_bytes_));
  }
  const int from = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  std::array<std::uint8_t, 65536> bytes{};
  bool good = from >= 0;
  for (off_t at = good ? lseek(from, 0, SEEK_DATA) : -1; good && at >= 0;
       at = lseek(from, at, SEEK_DATA)) {
    const ssize_t got = pread(from, bytes.data(), bytes.size(), at);
    good = got > 0;
    if (good) write(at, {bytes.data(), static_cast<std::size_t>(got)});
    if (good) at += got;
  }
  const std::string why = strerror(errno);
  if (from >= 0) close(from);
  if (good) return Done{};
  return refuse(ErrorKind::bad_input, path, "cannot be read: " + why);
}

void MemoryFile::read(std::int64_t at, std::span<std::uint8_t> into) const {
  WHIRL_CHECK(at >= 0 && at + std::ssize(into) <= size_bytes_, at, into.size());
  const ssize_t got = pread(fd_, into.data(), into.size(), at);
  if (got != std::ssize(into)) fail("read", got);
}

void MemoryFile::write(std::int64_t at, std::span<const std::uint8_t> bytes) {
  WHIRL_CHECK(at >= 0 && at + std::ssize(bytes) <= size_bytes_, at, bytes.size());
  const ssize_t put = pwrite(fd_, bytes.data(), bytes.size(), at);
  if (put != std::ssize(bytes)) fail("written", put);
}

void MemoryFile::clear(std::int64_t at, std::int64_t bytes) {
  WHIRL_CHECK(at >= 0 && bytes >= 0 && at + bytes <= size_bytes_, at, bytes);
  if (bytes == 0) return;
  if (fallocate(fd_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, at, bytes) == 0) return;
  constexpr std::array<std::uint8_t, 4096> kZeros{};  // a file system without holes
  for (std::int64_t done = 0; done < bytes; done += std::ssize(kZeros)) {
    const auto length = static_cast<std::size_t>(std::min<std::int64_t>(bytes - done, 4096));
    write(at + done, std::span(kZeros).first(length));
  }
}

}  // namespace whirl::io
