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
    case kPing:
      return 237;
    case kParamRequestRead:
      return 214;
    case kParamRequestList:
      return 159;
    case kParamValue:
      return 220;
    case kParamSet:
      return 168;
    case kGpsRawInt:
      return 24;
    case kAttitudeQuaternion:
      return 246;
    case kLocalPositionNed:
      return 185;
    case kMissionRequestList:
      return 132;
    case kMissionCount:
      return 221;
    case kMissionClearAll:
      return 232;
    case kMissionAck:
      return 153;
    case kCommandInt:
      return 158;
    case kGpsGlobalOrigin:
      return 39;
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
    case kTimesync:
      return 34;
    case kAutopilotVersion:
      return 178;
    case kStatustext:
      return 83;
    case kDebugFloatArray:
      return 232;
  }
  return -1;
}

bool Parser::push(std::uint8_t byte) {
  raw_[have_++] = byte;
  for (;;) {
    find_start();
    if (have_ < kHeader) return false;
    const int extra = crc_extra(message_id());
    if (extra < 0) {
      drop(1);
      continue;
    }
    const std::size_t end = kHeader + raw_[1],
                      total = end + 2 + ((raw_[2] & kSigned) != 0 ? kSignature : 0);
    if (have_ < total) return false;
    if (is_whole(end, static_cast<std::uint8_t>(extra))) {
      read_frame();
      drop(total);
      return true;
    }
    ++bad_frames_;
    drop(1);
  }
}

// Drops what no frame can begin with.
void Parser::find_start() {
  std::size_t at = 0;
  const auto may_begin = [this](std::size_t i) {
    return raw_[i] == kStart && (i + 2 >= have_ || (raw_[i + 2] & ~kSigned) == 0);
  };
  while (at < have_ && !may_begin(at)) ++at;
  if (at > 0) drop(at);
}

void Parser::drop(std::size_t bytes) {
  have_ -= bytes;
  std::memmove(raw_.data(), raw_.data() + bytes, have_);
}

std::uint32_t Parser::message_id() const {
  return raw_[7] | static_cast<std::uint32_t>(raw_[8]) << 8 |
         static_cast<std::uint32_t>(raw_[9]) << 16;
}

bool Parser::is_whole(std::size_t end, std::uint8_t extra) const {
  std::uint16_t crc = kCrcStart;
  for (std::size_t i = 1; i < end; ++i) crc = crc_add(crc, raw_[i]);
  return crc_add(crc, extra) == (raw_[end] | raw_[end + 1] << 8);
}

void Parser::read_frame() {
  frame_.length = raw_[1];
  frame_.sequence = raw_[4];
  frame_.system = raw_[5];
  frame_.component = raw_[6];
  frame_.id = message_id();
  frame_.payload.fill(0);
  std::memcpy(frame_.payload.data(), raw_.data() + kHeader, frame_.length);
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
