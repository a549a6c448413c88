// MAVLink v2 frames: bytes in, checked frames out, and the way back.
//
//   Source  mavlink.io/en/guide/serialization.html; CRC-16/MCRF4XX with the message's CRC_EXTRA
//   Accept  the messages we know. Signed frames are read, their signature is not checked; frames with
//           other incompatibility flags are dropped
//   Resync  what turns out to be no frame loses its first byte only, the rest is searched again: noise,
//           and messages that we do not know, swallow nothing of what follows them
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <span>

#include "firmware/link/crc16.hpp"

namespace fw::mavlink {

inline constexpr std::size_t kMaxPayload = 255, kOverhead = 12;
inline constexpr std::size_t kMaxSent = 64 + kOverhead;
inline constexpr std::uint8_t kSystem = 1, kComponent = 1;  // ours

enum MessageId : std::uint32_t {
  kHeartbeat = 0,
  kSysStatus = 1,
  kPing = 4,
  kParamRequestRead = 20,
  kParamRequestList = 21,
  kParamValue = 22,
  kParamSet = 23,
  kGpsRawInt = 24,
  kAttitudeQuaternion = 31,
  kLocalPositionNed = 32,
  kMissionRequestList = 43,
  kMissionCount = 44,
  kMissionClearAll = 45,
  kMissionAck = 47,
  kCommandInt = 75,
  kGpsGlobalOrigin = 49,
  kCommandLong = 76,
  kCommandAck = 77,
  kSetAttitudeTarget = 82,
  kSetPositionTargetLocalNed = 84,
  kViconPositionEstimate = 104,
  kHighresImu = 105,
  kTimesync = 111,
  kAutopilotVersion = 148,
  kStatustext = 253,
  kDebugFloatArray = 350,
};

// CRC_EXTRA, or -1 for a message we do not know.
int crc_extra(std::uint32_t id);

struct Frame {
  std::uint32_t id = 0;
  std::uint8_t system = 0, component = 0, sequence = 0, length = 0;
  std::array<std::uint8_t, kMaxPayload> payload{};

  // A field; what truncation cut off reads as zero.
  template <typename T>
  T get(std::size_t offset) const {
    T value{};
    std::memcpy(&value, payload.data() + offset, sizeof value);
    return value;
  }
};

class Parser {
 public:
  // True: frame() is complete and its CRC is right.
  bool push(std::uint8_t byte);
  const Frame& frame() const { return frame_; }
  std::uint32_t bad_frames() const { return bad_frames_; }

 private:
  void find_start();
  void drop(std::size_t bytes);
  std::uint32_t message_id() const;
  bool is_whole(std::size_t end, std::uint8_t extra) const;
  void read_frame();

  static constexpr std::size_t kHeader = 10, kSignature = 13;
  Frame frame_;
  std::array<std::uint8_t, kMaxPayload + kOverhead + kSignature> raw_{};  // from a start on
  std::size_t have_ = 0;                                                  // less than a frame
  std::uint32_t bad_frames_ = 0;
};

// The two bytes target_system and target_component at this offset name us; 0 is everybody.
inline bool for_us(const Frame& frame, std::size_t offset) {
  const auto system = frame.get<std::uint8_t>(offset),
             component = frame.get<std::uint8_t>(offset + 1);
  return (system == kSystem || system == 0) && (component == kComponent || component == 0);
}

// A message under construction: fields in any order, then the frame. No payload above 64 bytes.
class Message {
 public:
  Message(MessageId id, std::uint8_t length) : id_(id), length_(length) {}

  template <typename T>
  Message& put(std::size_t offset, T value) {
    std::memcpy(bytes_.data() + 10 + offset, &value, sizeof value);
    return *this;
  }
  // Valid as long as the message; no field may be put after it.
  std::span<const std::uint8_t> frame(std::uint8_t system, std::uint8_t component,
                                      std::uint8_t sequence);

 private:
  MessageId id_;
  std::uint8_t length_;
  std::array<std::uint8_t, kMaxSent> bytes_{};
};

}  // namespace fw::mavlink
