// The bit stream of DroneCAN's serialisation.
//
//   Order     fields one behind the other; a scalar's bytes least significant first, and of a last byte that
//             is not whole, its bits left-aligned: bit offsets count from the most significant bit of a byte
//   Source    dronecan/libcanard, canard.c (canardEncodeScalar); vectors of tests/dronecan_golden_test.cpp
//   Left out  types of CAN FD (arrays at the end carry no length here: tail array optimisation)
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace whirl::io::dronecan {

inline constexpr std::size_t kMost_payload = 1023;

// What a transfer carries. Bytes beyond size are zero.
struct Payload {
  std::size_t size = 0;
  std::array<std::uint8_t, kMost_payload> data{};

  std::span<const std::uint8_t> bytes() const { return std::span(data).first(size); }
};

class BitWriter {
 public:
  static constexpr bool kReads = false;

  // Pre: the payload is empty; the fields fit (every type's largest size does).
  explicit BitWriter(Payload& payload) : payload_(payload) {}

  void bits(std::uint64_t value, int count);
  std::size_t left() const { return 8 * kMost_payload - at_; }
  // The payload has whole bytes: zeros fill the last one.
  void close() { payload_.size = (at_ + 7) / 8; }

 private:
  Payload& payload_;
  std::size_t at_ = 0;
};

class BitReader {
 public:
  static constexpr bool kReads = true;

  explicit BitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  // Zero when fewer are left: ok() then says no, for good.
  std::uint64_t bits(int count);
  std::size_t left() const { return 8 * bytes_.size() - at_; }
  bool ok() const { return ok_; }
  void reject() { ok_ = false; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace whirl::io::dronecan
