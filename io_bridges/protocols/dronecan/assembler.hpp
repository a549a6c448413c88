// Puts transfers together from frames of any senders, mixed as they come; every one that is refused is counted
// by its cause.
//
//   Session   one per (kind, type, source, destination). At most 256: the one unused for longest makes room
//   Repeats   CAN may deliver a frame twice (an error in the last bit of its end): a frame whose toggle is the last
//             one's is dropped and the transfer goes on; a transfer with the id of the last one within 2 s is dropped
//   Lost      a frame that is missing shows at the CRC
//   Time-out  2 s from the first frame of a transfer (libcanard)
//   Two nodes of one id  spoil each other's long transfers (bad_crc, wrong_toggle, wrong_transfer_id); who tells
//             them apart is NodeWatch (node_watch.hpp)
//   Memory    grows with the sessions up to 256 of 1 kB; nothing is allocated for a session that is known
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "io_bridges/protocols/dronecan/bits.hpp"
#include "io_bridges/protocols/dronecan/transfer.hpp"

namespace whirl::io::dronecan {

struct Transfer {
  Header header;
  std::int64_t first_ns = 0, last_ns = 0;  // of its frames, as given to take()
  std::span<const std::uint8_t> payload;   // until the next call
};

struct TransferCounts {
  std::uint64_t frames = 0, transfers = 0;
  std::uint64_t not_dronecan =
      0;  // 11-bit identifiers, requests for data, identifiers no node sends
  std::uint64_t unknown_type = 0;   // whose signature we do not know: not ours to judge
  std::uint64_t not_for_us = 0;     // services of others
  std::uint64_t own_id = 0;         // another node sends under our id
  std::uint64_t empty_frame = 0;    // without a tail byte
  std::uint64_t bad_anonymous = 0;  // a node without id sent what needs one
  std::uint64_t bad_start = 0;      // a first frame whose toggle is set
  std::uint64_t short_frame = 0;    // not the last one, yet not full
  std::uint64_t missed_start = 0;   // goes on with what has not begun
  std::uint64_t wrong_toggle = 0;
  std::uint64_t wrong_transfer_id = 0;
  std::uint64_t repeated = 0;    // the transfer before, once more
  std::uint64_t unfinished = 0;  // a new one of its session began first
  std::uint64_t timed_out = 0;
  std::uint64_t too_long = 0;  // for its type
  std::uint64_t bad_crc = 0;
  std::uint64_t crowded_out = 0;  // its session had to make room
  std::uint64_t malformed = 0;    // whole, but not of its type's layout: counted by who decodes
};

// The type of a transfer, if its receiver knows it.
using TypeTable = std::function<const DataType*(Kind kind, std::uint16_t type_id)>;

class Assembler {
 public:
  // own_id 0: takes services between any nodes, as a listener does.
  explicit Assembler(TypeTable types, std::uint8_t own_id = 0)
      : types_(std::move(types)), own_id_(own_id) {}

  void own_id(std::uint8_t id) { own_id_ = id; }
  // A frame, in the order of arrival. Null, or the transfer that it completes, valid until the next call.
  const Transfer* take(const CanFrame& frame, std::int64_t now_ns);

  TransferCounts& counts() { return counts_; }
  const TransferCounts& counts() const { return counts_; }

 private:
  struct Session {
    std::uint64_t key = 0;
    std::int64_t used_ns = 0;   // the last frame
    std::int64_t first_ns = 0;  // of the transfer under way
    std::int64_t done_ns = 0;   // of the last whole one
    bool under_way = false, any_done = false;
    bool toggle = false;  // of the frame that comes next
    std::uint8_t transfer_id = 0, done_id = 0;
    std::size_t size = 0;  // the CRC's two bytes included
    std::array<std::uint8_t, kMost_payload + 2> data{};
  };
  struct Key {
    std::uint64_t key;
    std::unique_ptr<Session> session;
  };

  bool meant_for_us(const Header& header);
  Session& session_of(const Header& header, std::int64_t now_ns);
  void drop(Session& session, std::uint64_t& cause);
  bool begin(Session& session, const Header& header, const CanFrame& frame, std::int64_t now_ns);
  bool goes_on(Session& session, std::uint8_t tail, std::int64_t now_ns);
  bool add(Session& session, const DataType& type, std::span<const std::uint8_t> bytes);
  const Transfer* finish(Session& session, const Header& header, const DataType& type, bool many,
                         std::int64_t now_ns);
  const Transfer* take_anonymous(const Header& header, const CanFrame& frame, std::int64_t now_ns);

  TypeTable types_;
  std::uint8_t own_id_;
  std::vector<Key> sessions_;
  TransferCounts counts_;
  Transfer done_;
  std::array<std::uint8_t, 8> anonymous_{};
};

}  // namespace whirl::io::dronecan
