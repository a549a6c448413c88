// The link between the harness and one board process: shared memory and two futexes.
//
//   Shape     one mailbox each way; a mailbox holds the last two batches, so that what was received
//             stays readable while the next one is being written
//   Protocol  strictly alternating: the board posts what happened until t, the harness answers with
//             what is sensed at t and how far to run next
//   Waiting   a short spin, then a futex; nothing polls while the other side is alive
//   Limits    a batch beyond the capacity is refused by post() before it is copied
//   Cost      printed by link_cost (tests/): a few us when both sides have a core of their own
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "base/result.hpp"
#include "io_bridges/link/spin_policy.hpp"

namespace whirl::io {

enum class Side : std::uint32_t { harness = 0, board = 1 };

// What the board process says about itself beside its batches.
enum class BoardState : std::uint32_t {
  starting = 0,
  running = 1,
  failed = 2,      // failure() says why
  ended = 3,       // the last batch is in the mailbox
  cpu_locked = 4,  // as ended: the core cannot go on
};

struct Delivery {
  std::int64_t t_ns = 0;
  std::span<const std::uint8_t> bytes;
};

class Channel {
 public:
  static constexpr std::size_t kDefaultCapacity = std::size_t{16} << 20;

  static Result<Channel> create(Side side, std::size_t capacity = kDefaultCapacity);
  static Result<Channel> attach(Side side, int fd);
  Channel(Channel&& other) noexcept;
  Channel& operator=(Channel&&) = delete;
  ~Channel();

  int fd() const { return fd_; }  // inherited by the other process

  Result<Done> post(std::int64_t t_ns, std::span<const std::uint8_t> bytes);
  // True: a new delivery is there. False: the time-out (ms; negative: none) passed without one.
  bool wait(int timeout_ms);
  bool arrived() const;       // a delivery waits to be waited for
  Delivery received() const;  // of the last successful wait(); valid until the next but one post

  void set_state(BoardState state);
  BoardState state() const;
  void fail(const Error& error);  // board: names what is wrong, wakes the harness
  Error failure() const;
  void set_hello(const std::string& text);  // board: what it runs on, "name\tversion\n" lines
  std::string hello() const;

 private:
  struct Mailbox;
  struct Page;
  Channel(Side side, int fd, void* memory, std::size_t size);
  bool sleep_until(Mailbox& box, int timeout_ms) const;
  Mailbox& outgoing() const;
  Mailbox& incoming() const;
  std::uint8_t* data(const Mailbox& box, std::uint32_t sequence) const;

  Side side_;
  int fd_ = -1;
  Page* page_ = nullptr;
  std::size_t size_ = 0;
  std::uint32_t seen_ = 0;
  SpinPolicy spin_;
};

}  // namespace whirl::io
