// u-blox UBX frames: encoding, and a parser that finds its way back after any garbage.
//
//   Frame    B5 62, class, id, length (16 bits, low byte first), payload, CK_A, CK_B
//   Checksum Fletcher's of 8 bits over class .. end of payload
//   Resync   what fails loses its first byte only; the rest is searched again
//   Length   a frame that says it has more than max_payload bytes is no frame: a receiver has a
//            buffer, and garbage would else swallow up to 64 KiB of what follows
//   Source   PX4-GPSDrivers src/ubx.h, Betaflight io/gps.c (frames of both in tests/ubx_test.cpp)
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <vector>

namespace whirl::io {

struct UbxChecksum {
  std::uint8_t a = 0, b = 0;
  void add(std::uint8_t byte) {
    a = static_cast<std::uint8_t>(a + byte);
    b = static_cast<std::uint8_t>(b + a);
  }
};

struct UbxFrame {
  std::uint8_t message_class = 0, id = 0;
  std::vector<std::uint8_t> payload;

  // A field, low byte first; what the payload is too short for reads as zero.
  template <typename T>
  T get(std::size_t offset) const {
    T value{};
    if (offset + sizeof value <= payload.size()) {
      std::memcpy(&value, payload.data() + offset, sizeof value);
    }
    return value;
  }
};

// Pre: at most 65535 bytes of payload.
std::vector<std::uint8_t> encode(const UbxFrame& frame);

// Fields put one behind the other.
class UbxPayload {
 public:
  template <typename T>
  UbxPayload& put(T value) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), first, first + sizeof value);
    return *this;
  }
  UbxPayload& zeros(std::size_t count) {
    bytes_.resize(bytes_.size() + count);
    return *this;
  }
  UbxPayload& text(const char* words, std::size_t length);  // cut off or filled with zeros
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

class UbxParser {
 public:
  using FrameSink = std::function<void(const UbxFrame&)>;
  struct Counts {
    std::uint64_t frames = 0, bad_checksum = 0, too_long = 0;
    std::uint64_t stray = 0;  // bytes that belonged to no frame
  };

  explicit UbxParser(FrameSink on_frame, std::size_t max_payload = 512)
      : on_frame_(std::move(on_frame)), max_payload_(max_payload) {}

  void add(std::uint8_t byte);
  const Counts& counts() const { return counts_; }

 private:
  enum class Step : std::uint8_t { wait, drop, done };
  Step examine();
  Step examine_whole(std::size_t length);

  FrameSink on_frame_;
  std::size_t max_payload_;
  std::vector<std::uint8_t> buffer_;
  Counts counts_;
};

}  // namespace whirl::io
