#include "io_bridges/link/channel.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <climits>
#include <cstring>
#include <ctime>
#include <new>
#include <tuple>

#include "io_bridges/link/futex.hpp"

namespace whirl::io {
namespace {

constexpr std::uint64_t kMagic = 0x31306b6e696c6877;  // "whlink01"

long preemptions() {
  rusage use{};
  return getrusage(RUSAGE_THREAD, &use) == 0 ? use.ru_nivcsw : 0;
}

void copy_text(char* to, std::size_t room, const std::string& text) {
  const std::size_t size = std::min(text.size(), room - 1);
  std::memcpy(to, text.data(), size);
  to[size] = '\0';
}

}  // namespace

struct Channel::Mailbox {
  std::atomic<std::uint32_t> sequence;
  std::atomic<std::uint32_t> sleeping;
  std::int64_t t_ns[2];
  std::uint64_t size[2];
};

struct Channel::Page {
  std::uint64_t magic;
  std::uint64_t capacity;
  alignas(64) Mailbox from_harness;
  alignas(64) Mailbox from_board;
  alignas(64) std::atomic<std::uint32_t> state;
  std::uint32_t error_kind;
  char place[512], what[4096], cure[1024], hello[1024];
};

Result<Channel> Channel::create(Side side, std::size_t capacity) {
  const int fd = memfd_create("whirl-link", MFD_CLOEXEC);  // the board's launcher lets it through
  if (fd < 0)
    return Error{ErrorKind::host, "link", "no shared memory: " + std::string(std::strerror(errno)),
                 ""};
  const std::size_t size = sizeof(Page) + 4 * capacity;
  int status = 0;
  do {
    status = ftruncate(fd, static_cast<off_t>(size));
  } while (status != 0 && errno == EINTR);
  if (status != 0) {
    const std::string why = std::strerror(errno);
    close(fd);
    return Error{ErrorKind::host, "link",
                 "shared memory of " + std::to_string(size) + " bytes refused: " + why, ""};
  }
  void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (memory == MAP_FAILED) {
    close(fd);
    return Error{ErrorKind::host, "link", "shared memory cannot be mapped", ""};
  }
  Page* page = new (memory) Page{};
  page->capacity = capacity;
  page->magic = kMagic;
  return Channel(side, fd, memory, size);
}

Result<Channel> Channel::attach(Side side, int fd) {
  struct stat status {};
  if (fstat(fd, &status) != 0 || static_cast<std::size_t>(status.st_size) < sizeof(Page)) {
    return Error{ErrorKind::internal, "link", "descriptor " + std::to_string(fd) + " is no link",
                 ""};
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (memory == MAP_FAILED) return Error{ErrorKind::host, "link", "cannot be mapped", ""};
  const Page* page = static_cast<Page*>(memory);
  if (page->magic != kMagic || sizeof(Page) + 4 * page->capacity != size) {
    munmap(memory, size);
    return Error{ErrorKind::internal, "link", "the other side speaks another version", ""};
  }
  return Channel(side, fd, memory, size);
}

Channel::Channel(Side side, int fd, void* memory, std::size_t size)
    : side_(side), fd_(fd), page_(static_cast<Page*>(memory)), size_(size), spin_(own_cores()) {}

Channel::Channel(Channel&& other) noexcept
    : side_(other.side_),
      fd_(other.fd_),
      page_(other.page_),
      size_(other.size_),
      seen_(other.seen_),
      spin_(other.spin_) {
  other.fd_ = -1;
  other.page_ = nullptr;
}

Channel::~Channel() {
  if (page_ != nullptr) munmap(page_, size_);
  if (fd_ >= 0) close(fd_);
}

Channel::Mailbox& Channel::outgoing() const {
  return side_ == Side::harness ? page_->from_harness : page_->from_board;
}
Channel::Mailbox& Channel::incoming() const {
  return side_ == Side::harness ? page_->from_board : page_->from_harness;
}

std::uint8_t* Channel::data(const Mailbox& box, std::uint32_t sequence) const {
  const std::size_t slot = (&box == &page_->from_board ? 2 : 0) + (sequence & 1);
  return reinterpret_cast<std::uint8_t*>(page_ + 1) + slot * page_->capacity;
}

Result<Done> Channel::post(std::int64_t t_ns, std::span<const std::uint8_t> bytes) {
  if (bytes.size() > page_->capacity) {
    return Error{ErrorKind::internal, "link",
                 "a batch of " + std::to_string(bytes.size()) + " bytes is beyond the limit of " +
                     std::to_string(page_->capacity),
                 "shorten the step, or log less"};
  }
  Mailbox& box = outgoing();
  const std::uint32_t next = box.sequence.load(std::memory_order_relaxed) + 1;
  if (!bytes.empty()) std::memcpy(data(box, next), bytes.data(), bytes.size());
  box.t_ns[next & 1] = t_ns;
  box.size[next & 1] = bytes.size();
  box.sequence.store(next, std::memory_order_seq_cst);
  if (box.sleeping.load(std::memory_order_seq_cst) != 0)
    futex(box.sequence, FUTEX_WAKE, 1, nullptr);
  return Done{};
}

bool Channel::wait(int timeout_ms) {
  Mailbox& box = incoming();
  const int turns = timeout_ms == 0 ? SpinPolicy::kLeast : spin_.turns();
  for (int i = 0; i < turns; ++i) {
    if (box.sequence.load(std::memory_order_acquire) != seen_) {
      ++seen_;
      if (i > SpinPolicy::kLeast) spin_.waited(preemptions());
      return true;
    }
    relax();
  }
  if (turns > 0) spin_.waited(preemptions());
  box.sleeping.store(1, std::memory_order_seq_cst);
  const bool came = sleep_until(box, timeout_ms);
  box.sleeping.store(0, std::memory_order_relaxed);
  if (came) ++seen_;
  return came;
}

// A sleep may end for nothing: by a signal, or by the waking call of the delivery before this one,
// whose sender was held up between its store and that call.
bool Channel::sleep_until(Mailbox& box, int timeout_ms) const {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::milliseconds(timeout_ms);
  while (box.sequence.load(std::memory_order_seq_cst) == seen_) {
    const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(end - Clock::now());
    if (timeout_ms >= 0 && left.count() <= 0) return false;
    const timespec limit{left.count() / 1'000'000'000, left.count() % 1'000'000'000};
    futex(box.sequence, FUTEX_WAIT, seen_, timeout_ms < 0 ? nullptr : &limit);
  }
  return true;
}

bool Channel::arrived() const {
  return incoming().sequence.load(std::memory_order_acquire) != seen_;
}

Delivery Channel::received() const {
  const Mailbox& box = incoming();
  const std::uint64_t size = std::min<std::uint64_t>(box.size[seen_ & 1], page_->capacity);
  return {box.t_ns[seen_ & 1], {data(box, seen_), static_cast<std::size_t>(size)}};
}

void Channel::set_state(BoardState state) {
  page_->state.store(static_cast<std::uint32_t>(state), std::memory_order_release);
}

BoardState Channel::state() const {
  return static_cast<BoardState>(page_->state.load(std::memory_order_acquire));
}

void Channel::fail(const Error& error) {
  page_->error_kind = static_cast<std::uint32_t>(error.kind);
  copy_text(page_->place, sizeof page_->place, error.place);
  copy_text(page_->what, sizeof page_->what, error.what);
  copy_text(page_->cure, sizeof page_->cure, error.cure);
  set_state(BoardState::failed);
  std::ignore = post(-1, {});
}

Error Channel::failure() const {
  return {static_cast<ErrorKind>(page_->error_kind), page_->place, page_->what, page_->cure};
}

void Channel::set_hello(const std::string& text) {
  copy_text(page_->hello, sizeof page_->hello, text);
}

std::string Channel::hello() const {
  return page_->hello;
}

}  // namespace whirl::io
