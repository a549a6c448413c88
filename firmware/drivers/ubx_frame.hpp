// UBX frames: bytes in, checked frames out, and the way back.
//
//   Frame     B5 62, class, id, length (low byte first), payload, CK_A, CK_B (Fletcher over class .. payload)
//   Accept    payloads up to kMaxPayload; a longer one is no frame of ours and is dropped at its header, so
//             that garbage costs kMaxPayload bytes at most
//   Source    PX4-GPSDrivers src/ubx.h
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>

namespace fw::ubx {

inline constexpr std::size_t kMaxPayload = 96, kOverhead = 8;

struct Checksum {
  std::uint8_t a = 0, b = 0;
  constexpr void add(std::uint8_t byte) {
    a = static_cast<std::uint8_t>(a + byte);
    b = static_cast<std::uint8_t>(b + a);
  }
};

// A frame to send, with room for a payload of N bytes.
template <std::size_t N>
constexpr std::array<std::uint8_t, N + kOverhead> frame(
    std::uint8_t message_class, std::uint8_t id, const std::array<std::uint8_t, N>& payload) {
  static_assert(N < 256);
  std::array<std::uint8_t, N + kOverhead> bytes{};
  bytes[0] = 0xB5;
  bytes[1] = 0x62;
  bytes[2] = message_class;
  bytes[3] = id;
  bytes[4] = N;
  for (std::size_t i = 0; i < N; ++i) bytes[6 + i] = payload[i];
  Checksum sum;
  for (std::size_t i = 2; i < 6 + N; ++i) sum.add(bytes[i]);
  bytes[6 + N] = sum.a;
  bytes[7 + N] = sum.b;
  return bytes;
}

class Parser {
 public:
  // True: a frame is complete and its checksum is right.
  bool push(std::uint8_t byte) {
    switch (have_) {
      case 0:
        have_ = byte == 0xB5 ? 1 : 0;
        return false;
      case 1:
        have_ = byte == 0x62 ? 2 : byte == 0xB5 ? 1 : 0;
        sum_ = {};
        return false;
      default:
        return in_frame(byte);
    }
  }
  bool between_frames() const { return have_ == 0; }
  bool is(std::uint8_t message_class, std::uint8_t id, std::size_t length) const {
    return header_[0] == message_class && header_[1] == id && this->length() == length;
  }
  // A field of the payload. Pre: within its length.
  template <typename T>
  T get(std::size_t offset) const {
    T value{};
    std::memcpy(&value, payload_.data() + offset, sizeof value);
    return value;
  }
  std::uint32_t bad_frames() const { return bad_frames_; }

 private:
  static constexpr std::size_t kHeader = 6;

  std::size_t length() const { return header_[2] | static_cast<std::size_t>(header_[3]) << 8; }
  bool in_frame(std::uint8_t byte) {
    const std::size_t at = have_++;
    if (at < kHeader) {
      header_[at - 2] = byte;
      sum_.add(byte);
      if (at == kHeader - 1 && length() > kMaxPayload) return fail();
      return false;
    }
    const std::size_t end = kHeader + length();
    if (at < end) {
      payload_[at - kHeader] = byte;
      sum_.add(byte);
      return false;
    }
    if (at == end) return byte == sum_.a ? false : fail();
    have_ = 0;
    if (byte != sum_.b) return fail();
    return true;
  }
  bool fail() {
    have_ = 0;
    bad_frames_ = bad_frames_ + 1;
    return false;
  }

  std::array<std::uint8_t, 4> header_{};  // class, id, length
  std::array<std::uint8_t, kMaxPayload> payload_{};
  std::size_t have_ = 0;
  Checksum sum_;
  std::uint32_t bad_frames_ = 0;
};

}  // namespace fw::ubx
