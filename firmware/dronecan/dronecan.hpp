// DroneCAN (UAVCAN v0) for a node of the firmware: identifiers, tail bytes, bits, and transfers both ways.
//
//   Identifier  priority 28:24; message: type 23:8, 7 = 0, source 6:0; service: type 23:16, request 15,
//               destination 14:8, 7 = 1, source 6:0
//   Bits        a scalar's bytes least significant first, each from its most significant bit on; a last
//               piece that is no whole byte is left-aligned
//   Long ones   (8 bytes and more) begin with their CRC: CCITT-FALSE over the type's signature, then the
//               payload. A frame lost shows there; one that comes twice has its toggle twice
//   Source      dronecan.github.io/Specification; dronecan/libcanard
//   Error       the golden vectors and the host's codec (tests/dronecan_test.cpp)
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "firmware/hal/can_frame.hpp"
#include "firmware/status.hpp"

namespace fw::dronecan {

struct Type {
  std::uint16_t id;
  std::uint64_t signature;
};

inline constexpr Type kGetNodeInfo{1, 0xEE468A8121C46A9E}, kGetSet{11, 0xA7B622F939D1A4D5},
    kNodeStatus{341, 0x0F0868D0C1A7C6F1}, kRawCommand{1030, 0x217F5C87D7EC951D},
    kRpmCommand{1031, 0xCE0F9F621CF7E70B}, kEscStatus{1034, 0xA9AF28AEA2FBB254},
    kEscStatusExtended{1036, 0x02DC203C50960EDC};
// What sensors tell. The first two are of this house: 12 and 14 bytes.
inline constexpr Type kImu14{20100, 0x4D9F6E5A4D54FA92}, kImu16{20101, 0x6C55CA4E1C208322},
    kMagneticField2{1002, 0xB6AC0C442430297E}, kStaticPressure{1028, 0xCDC7C43412BDC89A},
    kStaticTemperature{1029, 0x49272A6477D96271}, kFix2{1063, 0xCA41E7000F37435F},
    kBatteryInfo{1092, 0x249C26548A711966};

constexpr std::uint32_t message_id(std::uint32_t priority, std::uint32_t type,
                                   std::uint32_t source) {
  return priority << 24 | type << 8 | source;
}
constexpr std::uint32_t service_id(std::uint32_t priority, std::uint32_t type, bool request,
                                   std::uint32_t destination, std::uint32_t source) {
  return priority << 24 | type << 16 | (request ? 1u << 15 : 0u) | destination << 8 | 1u << 7 |
         source;
}
constexpr std::uint8_t source_of(std::uint32_t id) {
  return static_cast<std::uint8_t>(id & 0x7F);
}
constexpr bool is_message(std::uint32_t id, const Type& type) {
  return (id & 1u << 7) == 0 && (id >> 8 & 0xFFFF) == type.id;
}
constexpr bool is_request_to(std::uint32_t id, const Type& type, std::uint32_t node) {
  return (id >> 7 & 0x1FFFF) == (type.id << 9 | 1u << 8 | node << 1 | 1u);
}

constexpr std::uint16_t crc_add(std::uint16_t crc, std::uint8_t byte) {
  std::uint32_t x = static_cast<std::uint32_t>(crc >> 8) ^ byte;
  x ^= x >> 4;
  return static_cast<std::uint16_t>(static_cast<std::uint32_t>(crc) << 8 ^ x << 12 ^ x << 5 ^ x);
}
constexpr std::uint16_t crc_of(std::uint64_t signature, std::span<const std::uint8_t> payload) {
  std::uint16_t crc = 0xFFFF;
  for (int i = 0; i < 64; i += 8) crc = crc_add(crc, static_cast<std::uint8_t>(signature >> i));
  for (const std::uint8_t byte : payload) crc = crc_add(crc, byte);
  return crc;
}

// Writes scalars into zeros. Pre: they fit.
class BitsOut {
 public:
  explicit constexpr BitsOut(std::span<std::uint8_t> bytes) : bytes_(bytes) {}

  constexpr BitsOut& put(std::uint32_t value, unsigned width) {
    for (; width > 8; width -= 8, value >>= 8) piece(value & 0xFF, 8);
    piece(value & ((1u << width) - 1u), width);
    return *this;
  }
  constexpr BitsOut& skip(unsigned width) {
    at_ += width;
    return *this;
  }
  constexpr std::size_t bytes() const { return (at_ + 7) / 8; }

 private:
  constexpr void piece(std::uint32_t value, unsigned width) {
    const std::uint32_t two = value << (16 - width - at_ % 8);  // over this byte and the next
    bytes_[at_ / 8] = static_cast<std::uint8_t>(bytes_[at_ / 8] | two >> 8);
    if (at_ % 8 + width > 8) bytes_[at_ / 8 + 1] = static_cast<std::uint8_t>(two);
    at_ += width;
  }

  std::span<std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

class BitsIn {
 public:
  explicit constexpr BitsIn(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  // 0 beyond the end: ok() then says no.
  constexpr std::uint32_t get(unsigned width) {
    std::uint32_t value = 0;
    unsigned shift = 0;
    for (; width > 8; width -= 8, shift += 8) value |= piece(8) << shift;
    return value | piece(width) << shift;
  }
  constexpr std::int32_t get_signed(unsigned width) {
    const unsigned unused = 32 - width;
    return static_cast<std::int32_t>(get(width) << unused) >> unused;
  }
  constexpr BitsIn& skip(unsigned width) {
    at_ += width;
    return *this;
  }
  constexpr std::size_t left() const {
    return 8 * bytes_.size() - std::min(at_, 8 * bytes_.size());
  }
  constexpr bool ok() const { return at_ <= 8 * bytes_.size(); }

 private:
  constexpr std::uint32_t piece(unsigned width) {
    const std::size_t byte = at_ / 8;
    const std::uint32_t two = (byte < bytes_.size() ? bytes_[byte] << 8 : 0u) |
                              (byte + 1 < bytes_.size() ? bytes_[byte + 1] : 0u);
    const unsigned down = static_cast<unsigned>(16 - at_ % 8) - width;
    at_ += width;
    return two >> down & ((1u << width) - 1u);
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

// IEEE half precision to single, exact. Of the other way only what nodes here send: finite numbers, to
// nearest, clamped to 65504.
constexpr float from_half(std::uint32_t half) {
  const std::uint32_t sign = (half & 0x8000) << 16, size = half & 0x7FFF;
  if (size >= 0x7C00) return std::bit_cast<float>(sign | 0x7F80'0000 | (size & 0x3FF) << 13);
  if (size < 0x400) {
    const float tiny = static_cast<float>(size) * 5.9604645e-8f;  // 2^-24
    return sign != 0 ? -tiny : tiny;
  }
  return std::bit_cast<float>(sign | ((size << 13) + (112u << 23)));
}
constexpr std::uint32_t to_half(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = bits >> 16 & 0x8000, size = bits & 0x7FFF'FFFF;
  if (size > 0x7F80'0000) return sign | 0x7E00;  // NaN: not known
  if (size < 0x3880'0000) {                      // below 2^-14: whole steps of 2^-24
    const float steps = std::bit_cast<float>(size) * 16777216.0f;
    const float up = steps + 0.5f;  // below 1024: exact
    return sign | static_cast<std::uint32_t>(up);
  }
  const std::uint32_t rounded = size + 0xFFF + (size >> 13 & 1);
  return sign | std::min<std::uint32_t>((rounded - (112u << 23)) >> 13, 0x7BFF);
}

inline constexpr std::uint8_t kStart = 0x80, kEnd = 0x40, kToggle = 0x20, kTransferId = 0x1F;

// Hands a transfer to `send` (Status of a CanFrame) frame by frame; the first that is refused ends it.
template <typename Send>
Status send_transfer(std::uint32_t id, std::uint8_t transfer_id, const Type& type,
                     std::span<const std::uint8_t> payload, Send&& send) {
  const bool is_long = payload.size() > 7;
  const std::uint16_t crc = is_long ? crc_of(type.signature, payload) : std::uint16_t{0};
  const std::size_t size = payload.size() + (is_long ? 2 : 0);
  const auto byte_at = [&](std::size_t i) {
    if (!is_long) return payload[i];
    if (i < 2) return static_cast<std::uint8_t>(crc >> 8 * i);
    return payload[i - 2];
  };
  std::size_t at = 0;
  std::uint8_t toggle = 0;
  do {
    hal::CanFrame frame;
    frame.id = id;
    const std::size_t begin = at;
    for (; at < size && at < begin + 7; ++at) frame.data[at - begin] = byte_at(at);
    const std::uint8_t ends = at == size ? kEnd : std::uint8_t{0};
    const std::uint8_t starts = begin == 0 ? kStart : std::uint8_t{0};
    frame.data[at - begin] =
        static_cast<std::uint8_t>(starts | ends | toggle | (transfer_id & kTransferId));
    frame.length = static_cast<std::uint8_t>(at - begin + 1);
    if (const Status s = send(frame); s != Status::ok) return s;
    toggle ^= kToggle;
  } while (at < size);
  return Status::ok;
}

// Puts one sender's transfers of one type together, up to kMost bytes.
template <std::size_t kMost>
class Reassembly {
 public:
  // True: payload() is whole and its CRC right.
  bool take(const hal::CanFrame& frame, const Type& type) {
    if (frame.length == 0) return false;
    const std::uint8_t tail = frame.data[frame.length - 1u];
    if ((tail & kStart) != 0) {
      spoiled_ += running_ && (tail & kTransferId) != transfer_id_ ? 1 : 0;
      size_ = skip_ = 0;
      toggle_ = 0;
      transfer_id_ = tail & kTransferId;
      running_ = true;
    }
    const bool goes_on = running_ && (tail & kTransferId) == transfer_id_;
    if (!goes_on) return drop();
    if ((tail & kToggle) != toggle_) return false;  // CAN may deliver a frame twice
    if (size_ + frame.length - 1 > bytes_.size()) return drop();
    std::copy_n(frame.data.begin(), frame.length - 1,
                bytes_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += frame.length - 1u;
    toggle_ ^= kToggle;
    if ((tail & kEnd) == 0) return false;
    running_ = false;
    skip_ = (tail & kStart) != 0 ? 0 : 2;
    if (skip_ == 0) return true;
    if (size_ < 2 || crc_of(type.signature, payload()) != (bytes_[0] | bytes_[1] << 8))
      return drop();
    return true;
  }
  std::span<const std::uint8_t> payload() const {
    return std::span(bytes_).first(size_).subspan(skip_);
  }
  std::uint8_t transfer_id() const { return transfer_id_; }
  std::uint32_t spoiled() const { return spoiled_; }

 private:
  bool drop() {
    spoiled_ += running_ || skip_ != 0 ? 1 : 0;
    running_ = false;
    skip_ = 0;
    return false;
  }

  std::array<std::uint8_t, kMost + 2> bytes_{};
  std::size_t size_ = 0, skip_ = 0;
  std::uint8_t toggle_ = 0, transfer_id_ = 0;
  bool running_ = false;
  std::uint32_t spoiled_ = 0;
};

}  // namespace fw::dronecan
