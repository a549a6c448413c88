// Preloaded into whirl: counts the sites that call the system, and lets one of them fail once.
//
//   Site      the call and the return addresses that lead to it; the driver takes address
//             randomisation away, so that they are the same in every run
//   Where     in programs called whirl only; the emulator keeps its calls
//   Left out  what libc calls within itself (stdio's writes, malloc's maps)
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "harness/tests/host_faults/site_table.hpp"

extern "C" char* program_invocation_short_name;

namespace {

using whirl::host_faults::Site;
using whirl::host_faults::SiteTable;

SiteTable* table = nullptr;
thread_local bool inside = false;  // finding a way back may itself call

__attribute__((constructor)) void begin() {
  const char* path = std::getenv(whirl::host_faults::kTableVariable);
  if (path == nullptr || std::strcmp(program_invocation_short_name, "whirl") != 0) return;
  const int fd = static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CLOEXEC));
  if (fd < 0) return;
  void* map = reinterpret_cast<void*>(
      syscall(SYS_mmap, nullptr, sizeof(SiteTable), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0L));
  syscall(SYS_close, fd);
  void* way[4];
  backtrace(way, 4);  // loads what it needs before anything is counted
  if (map != MAP_FAILED) table = static_cast<SiteTable*>(map);
}

__attribute__((noinline)) std::uint64_t hash_of_way(const char* call) {
  void* way[24];
  const int n = backtrace(way, 24);
  std::uint64_t hash = 14695981039346656037u;
  const auto add = [&](std::uint64_t x) { hash = (hash ^ x) * 1099511628211u; };
  for (const char* c = call; *c != '\0'; ++c) add(static_cast<unsigned char>(*c));
  for (int i = 3; i < n; ++i) add(reinterpret_cast<std::uintptr_t>(way[i]));
  return hash == 0 ? 1 : hash;
}

Site* site_of(std::uint64_t hash, const char* call) {
  for (std::size_t i = hash % whirl::host_faults::kSites, seen = 0;
       seen < whirl::host_faults::kSites; i = (i + 1) % whirl::host_faults::kSites, ++seen) {
    std::uint64_t free = 0;
    Site& site = table->sites[i];
    if (site.hash.compare_exchange_strong(free, hash)) {
      std::strncpy(site.call, call, sizeof site.call - 1);
      return &site;
    }
    if (free == hash) return &site;
  }
  return nullptr;
}

// Whether this call is to fail; errno is set then.
__attribute__((noinline)) bool fails(const char* call, const char* path = nullptr) {
  if (table == nullptr || inside) return false;
  inside = true;
  const int kept = errno;
  const std::uint64_t hash = hash_of_way(call);
  const std::uint32_t now = ++table->calls;
  if (path != nullptr && std::strstr(path, "truth.csv") != nullptr && table->judged == 0) {
    table->judged = now;
  }
  Site* site = site_of(hash, call);
  bool fail = false;
  if (site != nullptr) {
    const std::uint32_t n = ++site->count;
    if (n == 1) site->first = now;
    site->last = now;
    fail = hash == table->site && n == table->occurrence;
  }
  inside = false;
  errno = fail ? table->error : kept;
  if (fail) ++table->done;
  return fail;
}

template <typename F>
F real(const char* name, F) {
  return reinterpret_cast<F>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// One line per call: its result where it fails, its name, what it takes. (Declarations and types in
// parentheses would be others.)  NOLINTBEGIN(bugprone-macro-parentheses)
#define WHIRL_CALL(result, wrong, name, declared, given)                            \
  extern "C" __attribute__((visibility("default"))) result name declared {          \
    static const auto next = real(#name, static_cast<result(*) declared>(nullptr)); \
    return fails(#name) ? (wrong) : next given;                                     \
  }
#define WHIRL_OPEN(name, declared, given)                                                \
  extern "C" __attribute__((visibility("default"))) int name declared {                  \
    static const auto next = reinterpret_cast<int (*)(...)>(dlsym(RTLD_NEXT, #name));    \
    va_list rest;                                                                        \
    va_start(rest, flags);                                                               \
    const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0; \
    va_end(rest);                                                                        \
    return fails("open", path) ? -1 : next given;                                        \
  }

// NOLINTEND(bugprone-macro-parentheses)

WHIRL_OPEN(open, (const char* path, int flags, ...), (path, flags, mode))
WHIRL_OPEN(open64, (const char* path, int flags, ...), (path, flags, mode))
WHIRL_OPEN(openat, (int folder, const char* path, int flags, ...), (folder, path, flags, mode))
WHIRL_CALL(pid_t, -1, fork, (), ())
WHIRL_CALL(int, -1, execv, (const char* path, char* const argv[]), (path, argv))
WHIRL_CALL(int, -1, execvp, (const char* path, char* const argv[]), (path, argv))
WHIRL_CALL(ssize_t, -1, write, (int fd, const void* data, size_t n), (fd, data, n))
WHIRL_CALL(ssize_t, -1, writev, (int fd, const iovec* pieces, int n), (fd, pieces, n))
WHIRL_CALL(ssize_t, -1, pwrite, (int fd, const void* data, size_t n, off_t at), (fd, data, n, at))
WHIRL_CALL(ssize_t, -1, pwrite64, (int fd, const void* data, size_t n, off64_t at),
           (fd, data, n, at))
WHIRL_CALL(ssize_t, -1, read, (int fd, void* data, size_t n), (fd, data, n))
WHIRL_CALL(int, -1, rename, (const char* from, const char* to), (from, to))
WHIRL_CALL(int, -1, mkdir, (const char* path, mode_t mode), (path, mode))
WHIRL_CALL(char*, nullptr, mkdtemp, (char* path), (path))
WHIRL_CALL(int, -1, symlink, (const char* to, const char* path), (to, path))
WHIRL_CALL(int, -1, ftruncate, (int fd, off_t size), (fd, size))
WHIRL_CALL(int, -1, ftruncate64, (int fd, off64_t size), (fd, size))
WHIRL_CALL(int, -1, fsync, (int fd), (fd))
WHIRL_CALL(int, -1, fdatasync, (int fd), (fd))
WHIRL_CALL(int, -1, memfd_create, (const char* name, unsigned flags), (name, flags))
WHIRL_CALL(pid_t, -1, wait, (int* status), (status))
WHIRL_CALL(pid_t, -1, waitpid, (pid_t pid, int* status, int options), (pid, status, options))
WHIRL_CALL(int, -1, dup2, (int from, int to), (from, to))
WHIRL_CALL(FILE*, nullptr, popen, (const char* command, const char* mode), (command, mode))
WHIRL_CALL(FILE*, nullptr, fopen, (const char* path, const char* mode), (path, mode))
WHIRL_CALL(void*, MAP_FAILED, mmap, (void* at, size_t n, int what, int how, int fd, off_t from),
           (at, n, what, how, fd, from))

// It is closed all the same, as Linux does.
extern "C" __attribute__((visibility("default"))) int close(int fd) {
  const bool fail = fails("close");
  const int error = errno;
  const auto result = static_cast<int>(syscall(SYS_close, fd));
  if (!fail) return result;
  errno = error;
  return -1;
}
