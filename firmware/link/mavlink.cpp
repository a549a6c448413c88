#include "firmware/link/mavlink.hpp"

namespace fw::mavlink {
namespace {

constexpr std::uint8_t kStart = 0xFD;
constexpr std::uint8_t kSigned = 0x01;

}  // namespace

int crc_extra(std::uint32_t id) {
  switch (id) {
    case kHeartbeat:
      return 50;
    case kSysStatus:
      return 124;
    case kParamRequestRead:
      return 214;
    case kParamRequestList:
      return 159;
    case kParamValue:
      return 220;
    case kParamSet:
      return 168;
    case kAttitudeQuaternion:
      return 246;
    case kLocalPositionNed:
      return 185;
    case kCommandLong:
      return 152;
    case kCommandAck:
      return 143;
    case kSetAttitudeTarget:
      return 49;
    case kSetPositionTargetLocalNed:
      return 143;
    case kViconPositionEstimate:
      return 56;
    case kHighresImu:
      return 93;
    case kStatustext:
      return 83;
    case kDebugFloatArray:
      return 232;
  }
  return -1;
}

bool Parser::push(std::uint8_t byte) {
  const std::size_t at = have_++;
  if (at == 0) {
    if (byte != kStart) have_ = 0;
    return false;
  }
  if (at < kHeader) {
    header_[at] = byte;
    if (at == 2 && (byte & ~kSigned) != 0) have_ = 0;
    if (at + 1 == kHeader) begin_payload();
    return false;
  }
  const std::size_t payload_end = kHeader + frame_.length;
  if (at < payload_end) {
    frame_.payload[at - kHeader] = byte;
    crc_ = crc_add(crc_, byte);
  } else if (at == payload_end) {
    crc_received_ = byte;
  } else if (at == payload_end + 1) {
    crc_received_ = static_cast<std::uint16_t>(crc_received_ | byte << 8);
  }
  return have_ == total_ && end_frame();
}

void Parser::begin_payload() {
  frame_.length = header_[1];
  frame_.sequence = header_[4];
  frame_.system = header_[5];
  frame_.component = header_[6];
  frame_.id = header_[7] | static_cast<std::uint32_t>(header_[8]) << 8 |
              static_cast<std::uint32_t>(header_[9]) << 16;
  frame_.payload.fill(0);
  total_ = kHeader + frame_.length + 2 + ((header_[2] & kSigned) != 0 ? kSignature : 0);
  crc_ = kCrcStart;
  for (std::size_t i = 1; i < kHeader; ++i) crc_ = crc_add(crc_, header_[i]);
}

bool Parser::end_frame() {
  have_ = 0;
  const int extra = crc_extra(frame_.id);
  if (extra < 0) return false;
  if (crc_add(crc_, static_cast<std::uint8_t>(extra)) == crc_received_) return true;
  ++bad_frames_;
  return false;
}

std::span<const std::uint8_t> Message::frame(std::uint8_t system, std::uint8_t component,
                                             std::uint8_t sequence) {
  while (length_ > 1 && bytes_[10u + length_ - 1] == 0) --length_;
  const std::array<std::uint8_t, 10> header{kStart,
                                            length_,
                                            0,
                                            0,
                                            sequence,
                                            system,
                                            component,
                                            static_cast<std::uint8_t>(id_),
                                            static_cast<std::uint8_t>(id_ >> 8),
                                            static_cast<std::uint8_t>(id_ >> 16)};
  std::memcpy(bytes_.data(), header.data(), header.size());
  std::uint16_t crc = kCrcStart;
  const std::size_t end = 10u + length_;
  for (std::size_t i = 1; i < end; ++i) crc = crc_add(crc, bytes_[i]);
  crc = crc_add(crc, static_cast<std::uint8_t>(crc_extra(id_)));
  bytes_[end] = static_cast<std::uint8_t>(crc);
  bytes_[end + 1] = static_cast<std::uint8_t>(crc >> 8);
  return {bytes_.data(), end + 2};
}

}  // namespace fw::mavlink
