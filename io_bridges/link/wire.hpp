// A wire between two boards' processes: one page of shared memory, a ring of messages down, one answer and a
// ring of edges, levels and characters up. The bus master's board leads, the slave's board follows behind it in virtual time.
//
//   Ports     what two boards have between them is one wire, so that the follower sees all of it in one order: a bus
//             each, and what belongs to it
//   Order     messages carry the leader's virtual time, which never falls. Every read blocks and none
//             polls, so what happens depends on the messages and not on who was faster
//   Waiting   as long as a core is free for it, then a futex: long turns where there are more cores than
//             boards, few where looking would take the core from the one that is waited for
//   Ends      close() wakes both sides, whatever they wait for: their calls then say that it is closed
//   Life      it ends with the last process that has it open
#pragma once
#include <atomic>
#include <cstdint>
#include <optional>

#include "base/result.hpp"

namespace whirl::io {

enum class WireAct : std::uint8_t {
  to_boundary,  // nothing more comes before the next boundary. No answer
  start,        // no answer; also of transactions for others
  stop,         // likewise
  address,      // flag: a read. Answer: ACK
  write,        // answer: ACK
  fetch,        // answer: the byte
  acked,        // flag: the master's acknowledge; with it an answer: the next byte, else none
  still_held,   // after an answer that the clock is held. Answer: of the act that it was for
  select,       // of SPI. flag: selected. No answer
  spi_begin,    // the first clock of a byte. byte: the mode. No answer
  spi_end,      // its last bit has passed. byte: MOSI. Answer: MISO
  mark,         // no answer, but a mark in the ring up: all edges until then are in it
  character,    // of a UART: its last stop bit has passed. No answer
  can_news,     // of CAN, from who arbitrates: a station is told something. No answer
  can_stir,     // a station that takes no part sees a start of frame at t_ns. No answer
  can_go,       // run on until t_ns: nothing comes before
};

// Of CAN, from a board that does not arbitrate. Each stands for its station but the last.
enum class WireCanAct : std::uint8_t {
  configure,
  connect,
  disconnect,
  offer,     // it has this frame to send
  withdraw,  // it has none
  stopped,   // the board stands at t_ns, and has said all that it asked before. level: and at t_ns
};

struct WireCan {
  double bit_ns = 0.0;
  std::uint32_t id = 0;
  std::uint8_t data[8] = {};
  std::uint8_t length = 0;
  bool extended = false, remote = false;
  bool silent = false, sending = false, bus_off = false;
  std::uint8_t station = 0, act = 0, error = 0;
  std::int16_t tec = 0, rec = 0, idles = 0;
};

// What a UART sends, and how it had set up its end.
struct WireCharacter {
  double baud = 0.0;
  std::uint8_t byte = 0, data_bits = 8, half_stop_bits = 2;
  char parity = 'N';
  bool framing_error = false, noise = false, is_break = false, inverted = false;
};

struct WireMessage {
  std::int64_t t_ns = 0;
  WireAct act = WireAct::start;
  std::uint8_t byte = 0, flag = 0, port = 0;
  WireCharacter character = {};
  WireCan can = {};
};

// From the follower to the leader: a line's edge, a new level, or a character whose start bit is here.
struct WireEdge {
  std::int64_t t_ns = 0;
  std::uint8_t port = 0, level = 0, mark = 0;  // mark: no edge, see WireAct
  double level_V = 0.0;                        // of an analog line
  std::int64_t until_ns = 0;                   // of a character: its last stop bit has passed
  WireCharacter character = {};
  WireCan can = {};
};

struct WireAnswer {
  enum class Clock : std::uint8_t {
    released,          // at t_ns
    held,              // still at t_ns: ask again then
    held_to_boundary,  // ask again after it
  };
  std::int64_t t_ns = 0;
  Clock clock = Clock::released;
  std::uint8_t ack = 0, byte = 0;
  bool has_byte = false;
};

class BoardWire {
 public:
  // boards: how many processes of the run want a core of their own.
  static Result<BoardWire> create(int boards);
  static Result<BoardWire> attach(int fd);
  BoardWire(BoardWire&& other) noexcept;
  BoardWire& operator=(BoardWire&&) = delete;
  ~BoardWire();

  int fd() const { return fd_; }  // inherited by both boards

  // Leader. False, nothing: the wire is closed. more: others follow at once, so nobody is woken for this one.
  bool post(const WireMessage& message,  // waits for room, and never for long: the follower drains
            bool more = false);
  std::optional<WireAnswer> ask(const WireMessage& message);
  std::optional<WireEdge> next_edge();  // waits for one

  // Follower.
  const WireMessage* front();  // waits for one; null: closed
  void pop();
  void answer(const WireAnswer& answer);
  // Pre: fewer than kMost_edges are there that the leader has not taken.
  static constexpr std::uint32_t kMost_edges = 1024;
  void tell(const WireEdge& edge, bool more = false);

  // The harness, when one of the two is gone or the run has ended otherwise.
  void close();
  bool leader_waits() const;
  bool follower_waits() const;

 private:
  struct Page;
  BoardWire(int fd, void* memory);
  template <typename Ready>
  bool await(std::atomic<std::uint32_t>& word, std::atomic<std::uint32_t>& sleeps, Ready ready);
  void wake_follower();

  int fd_ = -1;
  Page* page_ = nullptr;
  int turns_ = 0;
};

}  // namespace whirl::io
