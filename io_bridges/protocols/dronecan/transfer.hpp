// DroneCAN transfers as CAN frames: the identifier, the tail byte, and the cutting into frames.
//
//   Identifier  29 bits: priority 28:24; message: type 23:8, source 6:0; service: bit 7, type 23:16, request 15,
//               destination 14:8; from a node without id (source 0): type's low 2 bits 9:8, discriminator 23:10
//   Tail byte   start 7, end 6, toggle 5, transfer id 4:0. A transfer of 7 bytes or fewer is one frame without a
//               CRC; a longer one starts with its CRC (low byte first)
//   CRC         CRC-16/CCITT-FALSE over the type's signature (low byte first), then the payload
//   Source      dronecan/libcanard @601ed354
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "io_bridges/protocols/can_frame.hpp"
#include "io_bridges/protocols/dronecan/data_type.hpp"

namespace whirl::io::dronecan {

struct Header {
  Kind kind = Kind::message;
  std::uint16_t type_id = 0;
  std::uint8_t priority = 16;    // 0 wins .. 31
  std::uint8_t source = 0;       // 1..127; 0: has no id yet
  std::uint8_t destination = 0;  // of services
  std::uint8_t transfer_id = 0;  // 0..31
  bool operator==(const Header&) const = default;
};

// The discriminator of a node without id comes from its payload: two of them rarely send the same identifier.
std::uint32_t can_id(const Header& header, std::span<const std::uint8_t> payload);
// Without the transfer id. Nothing: no such identifier is sent by a DroneCAN node.
std::optional<Header> parse_can_id(std::uint32_t id);

std::uint16_t transfer_crc(std::uint64_t signature, std::span<const std::uint8_t> payload);

namespace tail {
inline constexpr std::uint8_t kStart = 0x80, kEnd = 0x40, kToggle = 0x20, kTransfer_id = 0x1F;
}

// The frames of one transfer, one after the other; the payload must live as long.
class TransferFrames {
 public:
  // Pre: at most 1023 bytes; at most 7 and a message of type 0..3 if the source is 0.
  TransferFrames(const Header& header, std::uint64_t signature,
                 std::span<const std::uint8_t> payload);
  // False: that was the last one.
  bool next(CanFrame& frame);

 private:
  std::span<const std::uint8_t> payload_;
  std::uint32_t id_;
  std::uint16_t crc_ = 0;
  std::uint8_t transfer_id_;
  bool many_;
  bool toggle_ = false;
  std::size_t at_ = 0;  // bytes sent, the CRC counted
};

std::vector<CanFrame> frames_of(const Header& header, std::uint64_t signature,
                                std::span<const std::uint8_t> payload);

// Transfer ids count by type, kind and destination.
class TransferIds {
 public:
  std::uint8_t next(Kind kind, std::uint16_t type_id, std::uint8_t destination = 0);

 private:
  struct Count {
    Kind kind;
    std::uint16_t type_id;
    std::uint8_t destination, next;
  };
  std::vector<Count> counts_;
};

}  // namespace whirl::io::dronecan
