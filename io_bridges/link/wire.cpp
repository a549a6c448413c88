#include "io_bridges/link/wire.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <new>

#include "base/check.hpp"
#include "io_bridges/link/futex.hpp"
#include "io_bridges/link/spin_policy.hpp"

namespace whirl::io {
namespace {

constexpr std::uint64_t kWire_magic = 0x3430657269776877;  // "whwire04"
constexpr std::uint32_t kRing = 256;                       // messages
constexpr int kFew_turns = 4 * SpinPolicy::kLeast;
// A sleeper looks again so often: close() may come between its look and its sleep.
constexpr timespec kNap{0, 50'000'000};

// Long turns pay where the other side has a core of its own, and halve the speed where it has not.
int turns_for(int boards) {
  const int cores = own_cores();
  if (cores < 2) return 0;
  return boards + 1 <= cores ? SpinPolicy::kMost : kFew_turns;
}

}  // namespace

struct BoardWire::Page {
  std::uint64_t magic;
  std::int32_t boards;
  std::atomic<std::uint32_t> closed;
  alignas(64) std::atomic<std::uint32_t> posted;
  std::atomic<std::uint32_t> leader_sleeps;
  alignas(64) std::atomic<std::uint32_t> taken;
  std::atomic<std::uint32_t> answered, follower_sleeps;
  std::uint32_t asked;  // the leader's own
  WireAnswer answer;
  alignas(64) std::atomic<std::uint32_t> told;
  alignas(64) std::atomic<std::uint32_t> heard;
  alignas(64) WireMessage ring[kRing];
  WireEdge edges[kMost_edges];
};

Result<BoardWire> BoardWire::create(int boards) {
  const int fd = memfd_create("whirl-wire", MFD_CLOEXEC);  // the boards' launcher lets it through
  void* memory = MAP_FAILED;
  if (fd >= 0 && ftruncate(fd, sizeof(Page)) == 0) {
    memory = mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  }
  if (memory == MAP_FAILED) {
    const std::string why = std::strerror(errno);
    if (fd >= 0) ::close(fd);
    return Error{ErrorKind::host, "wire", "no shared memory: " + why, ""};
  }
  Page* page = new (memory) Page{};
  page->boards = boards;
  page->magic = kWire_magic;
  return BoardWire(fd, memory);
}

Result<BoardWire> BoardWire::attach(int fd) {
  struct stat status {};
  const bool there = fstat(fd, &status) == 0 && status.st_size == sizeof(Page);
  void* memory =
      there ? mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0) : MAP_FAILED;
  if (memory == MAP_FAILED || static_cast<Page*>(memory)->magic != kWire_magic) {
    if (memory != MAP_FAILED) munmap(memory, sizeof(Page));
    return Error{ErrorKind::internal, "wire", "descriptor " + std::to_string(fd) + " is no wire",
                 ""};
  }
  return BoardWire(fd, memory);
}

BoardWire::BoardWire(int fd, void* memory)
    : fd_(fd), page_(static_cast<Page*>(memory)), turns_(turns_for(page_->boards)) {}

BoardWire::BoardWire(BoardWire&& other) noexcept
    : fd_(other.fd_), page_(other.page_), turns_(other.turns_) {
  other.fd_ = -1;
  other.page_ = nullptr;
}

BoardWire::~BoardWire() {
  if (page_ != nullptr) munmap(page_, sizeof(Page));
  if (fd_ >= 0) ::close(fd_);
}

template <typename Ready>
bool BoardWire::await(std::atomic<std::uint32_t>& word, std::atomic<std::uint32_t>& sleeps,
                      Ready ready) {
  for (int i = 0; i < turns_; ++i) {
    if (ready(word.load(std::memory_order_acquire))) return true;
    relax();
  }
  sleeps.store(1, std::memory_order_seq_cst);
  std::uint32_t seen = word.load(std::memory_order_seq_cst);
  while (!ready(seen) && page_->closed.load(std::memory_order_acquire) == 0) {
    futex(word, FUTEX_WAIT, seen, &kNap);
    seen = word.load(std::memory_order_seq_cst);
  }
  sleeps.store(0, std::memory_order_relaxed);
  return ready(seen);
}

bool BoardWire::post(const WireMessage& message, bool more) {
  if (page_->closed.load(std::memory_order_acquire) != 0) return false;
  const std::uint32_t posted = page_->posted.load(std::memory_order_relaxed);
  const auto room = [posted](std::uint32_t taken) { return posted - taken < kRing; };
  if (!room(page_->taken.load(std::memory_order_acquire))) wake_follower();  // perhaps for more
  if (!await(page_->taken, page_->leader_sleeps, room)) return false;
  page_->ring[posted % kRing] = message;
  page_->posted.store(posted + 1, std::memory_order_seq_cst);
  if (!more) wake_follower();
  return true;
}

void BoardWire::wake_follower() {
  if (page_->follower_sleeps.load(std::memory_order_seq_cst) != 0) {
    futex(page_->posted, FUTEX_WAKE, 1, nullptr);
  }
}

std::optional<WireAnswer> BoardWire::ask(const WireMessage& message) {
  if (!post(message)) return std::nullopt;
  const std::uint32_t wanted = ++page_->asked;
  const auto came = [wanted](std::uint32_t answered) { return answered == wanted; };
  if (!await(page_->answered, page_->leader_sleeps, came)) return std::nullopt;
  return page_->answer;
}

const WireMessage* BoardWire::front() {
  const std::uint32_t taken = page_->taken.load(std::memory_order_relaxed);
  const auto any = [taken](std::uint32_t posted) { return posted != taken; };
  if (!await(page_->posted, page_->follower_sleeps, any)) return nullptr;
  return &page_->ring[taken % kRing];
}

void BoardWire::pop() {
  page_->taken.store(page_->taken.load(std::memory_order_relaxed) + 1, std::memory_order_seq_cst);
  if (page_->leader_sleeps.load(std::memory_order_seq_cst) != 0) {
    futex(page_->taken, FUTEX_WAKE, 1, nullptr);
  }
}

void BoardWire::answer(const WireAnswer& answer) {
  page_->answer = answer;
  page_->answered.store(page_->answered.load(std::memory_order_relaxed) + 1,
                        std::memory_order_seq_cst);
  if (page_->leader_sleeps.load(std::memory_order_seq_cst) != 0) {
    futex(page_->answered, FUTEX_WAKE, 1, nullptr);
  }
}

std::optional<WireEdge> BoardWire::next_edge() {
  const std::uint32_t heard = page_->heard.load(std::memory_order_relaxed);
  const auto any = [heard](std::uint32_t told) { return told != heard; };
  if (!await(page_->told, page_->leader_sleeps, any)) return std::nullopt;
  const WireEdge edge = page_->edges[heard % kMost_edges];
  page_->heard.store(heard + 1, std::memory_order_release);
  return edge;
}

void BoardWire::tell(const WireEdge& edge, bool more) {
  const std::uint32_t told = page_->told.load(std::memory_order_relaxed);
  WHIRL_CHECK(told - page_->heard.load(std::memory_order_acquire) < kMost_edges, edge.t_ns);
  page_->edges[told % kMost_edges] = edge;
  page_->told.store(told + 1, std::memory_order_seq_cst);
  if (more) return;
  if (page_->leader_sleeps.load(std::memory_order_seq_cst) != 0) {
    futex(page_->told, FUTEX_WAKE, 1, nullptr);
  }
}

void BoardWire::close() {
  page_->closed.store(1, std::memory_order_seq_cst);
  for (auto* word : {&page_->posted, &page_->taken, &page_->answered, &page_->told}) {
    futex(*word, FUTEX_WAKE, INT32_MAX, nullptr);
  }
}

bool BoardWire::leader_waits() const {
  return page_->leader_sleeps.load(std::memory_order_acquire) != 0;
}

bool BoardWire::follower_waits() const {
  return page_->follower_sleeps.load(std::memory_order_acquire) != 0;
}

}  // namespace whirl::io
