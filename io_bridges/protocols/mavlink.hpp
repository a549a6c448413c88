// MAVLink frames: encoding (version 2) and a parser that finds its way back after any garbage.
//
//   Frame      v2: FD, length, incompat, compat, seq, sysid, compid, msgid (24 bit), payload, CRC;
//              v1 (FE, 8-bit msgid) is accepted on reception
//   CRC        CRC-16/MCRF4XX from the length byte to the payload's end, then CRC_EXTRA
//   Truncation trailing zero bytes of a v2 payload are not sent (one byte at least is); the
//              receiver reads them as zeros
//   Resync     what fails its CRC loses its first byte only; the rest is searched again
//   Left out   signing (a signed frame is dropped and counted: an unknown incompat flag)
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace whirl::io {

struct MavlinkInfo {
  std::uint32_t id;
  const char* name;
  std::uint8_t max_length;
  std::uint8_t min_length;  // base fields only: all that v1 carries
  std::uint8_t crc_extra;
};

// Null when the message is not in the table.
const MavlinkInfo* mavlink_info(std::uint32_t id);

struct MavlinkFrame {
  std::uint8_t seq = 0;
  std::uint8_t sysid = 0;
  std::uint8_t compid = 0;
  std::uint32_t msgid = 0;
  std::uint8_t length = 0;                  // of the payload, as sent or received
  std::array<std::uint8_t, 255> payload{};  // zeros beyond length
};

// Version 2, trailing zeros cut. Pre: the message is in the table.
std::vector<std::uint8_t> encode(const MavlinkFrame& frame);

class MavlinkParser {
 public:
  using FrameSink = std::function<void(const MavlinkFrame&, std::span<const std::uint8_t> raw)>;
  struct Counts {
    std::uint64_t frames = 0;
    std::uint64_t bad_crc = 0;
    std::uint64_t unknown = 0;  // message ids that the table does not know
    std::uint64_t stray = 0;    // bytes that belonged to no frame
    std::uint64_t lost = 0;     // gaps in seq (one sender per link is assumed)
  };

  explicit MavlinkParser(FrameSink on_frame) : on_frame_(std::move(on_frame)) {}

  void add(std::uint8_t byte);
  // A frame is under way; its sender owes the rest.
  bool in_frame() const { return !buffer_.empty(); }
  const Counts& counts() const { return counts_; }

 private:
  enum class Step : std::uint8_t { wait, drop, done };
  Step examine();
  Step examine_whole(bool v1, std::size_t header, std::size_t length);
  void deliver(bool v1, std::size_t header, std::size_t length);

  FrameSink on_frame_;
  std::vector<std::uint8_t> buffer_;
  Counts counts_;
  std::optional<std::uint8_t> last_seq_;
};

}  // namespace whirl::io
