// What goes over the wire to an SD card and comes back: frames, answers, data blocks. No state of a
// card, no bus.
//
//   Source  SD Physical Layer Simplified Specification 4.10, 4.5 (CRC), 5.3 (CSD), 7.2 and 7.3
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "firmware/status.hpp"

namespace fw::sd {

inline constexpr std::size_t kBlock_bytes = 512;
inline constexpr std::size_t kFrame_bytes = 1 + 1 + kBlock_bytes + 2 + 1;  // the longest exchange
using Frame = std::array<std::uint8_t, kFrame_bytes>;

constexpr std::uint8_t crc7_add(std::uint8_t crc, std::uint8_t byte) {
  for (int bit = 7; bit >= 0; --bit) {
    const unsigned top = (crc >> 6 ^ byte >> bit) & 1u;
    crc = static_cast<std::uint8_t>(((crc << 1) & 0x7F) ^ (top != 0 ? 0x09 : 0));
  }
  return crc;
}

// XMODEM's: a byte at a time, without a table.
constexpr std::uint16_t crc16_add(std::uint16_t crc, std::uint8_t byte) {
  auto x = static_cast<std::uint8_t>((crc >> 8) ^ byte);
  x = static_cast<std::uint8_t>(x ^ (x >> 4));
  return static_cast<std::uint16_t>((crc << 8) ^ (x << 12) ^ (x << 5) ^ x);
}

// Each fills the frame's start with what is to be sent, and returns its length.
inline std::size_t put_clocks(Frame& frame, std::size_t bytes) {
  std::fill_n(frame.begin(), bytes, 0xFF);
  return bytes;
}

// A byte to breathe, six of command, up to nine until R1 and four behind it.
inline std::size_t put_command(Frame& frame, std::uint8_t index, std::uint32_t argument) {
  put_clocks(frame, 1 + 6 + 9 + 4);
  std::uint8_t crc = 0;
  for (unsigned i = 0; i < 5; ++i) {
    const std::uint32_t byte = i == 0 ? 0x40u | index : argument >> (8 * (4 - i));
    frame[1 + i] = static_cast<std::uint8_t>(byte);
    crc = crc7_add(crc, frame[1 + i]);
  }
  frame[6] = static_cast<std::uint8_t>(crc << 1 | 1);
  return 1 + 6 + 9 + 4;
}

// A block of CMD25, and a byte for the card's response to it.
inline std::size_t put_block(Frame& frame, std::span<const std::uint8_t, kBlock_bytes> bytes) {
  frame[0] = 0xFF;
  frame[1] = 0xFC;
  std::uint16_t crc = 0;
  for (std::size_t i = 0; i < kBlock_bytes; ++i) {
    frame[2 + i] = bytes[i];
    crc = crc16_add(crc, bytes[i]);
  }
  frame[2 + kBlock_bytes] = static_cast<std::uint8_t>(crc >> 8);
  frame[3 + kBlock_bytes] = static_cast<std::uint8_t>(crc & 0xFF);
  frame[4 + kBlock_bytes] = 0xFF;
  return kFrame_bytes;
}

inline std::size_t put_stop(Frame& frame) {
  put_clocks(frame, 3);
  frame[1] = 0xFD;
  return 3;
}

inline Status data_response(std::uint8_t byte) {
  switch (byte & 0x1F) {
    case 0x05:
      return Status::ok;
    case 0x0B:
    case 0x0D:
      return Status::bad_data;
    default:
      return Status::no_answer;
  }
}

struct Answer {
  std::uint8_t r1 = 0xFF;                // 0xFF: none came
  std::array<std::uint8_t, 4> after{};   // of R2, R3, R7
  std::span<const std::uint8_t> rest{};  // all behind R1: a data block may have begun
};

// Of the exchange that put_command() began.
inline Answer find_answer(std::span<const std::uint8_t> received) {
  for (std::size_t i = 7; i < 7 + 9; ++i) {
    if ((received[i] & 0x80) != 0) continue;
    Answer answer{received[i], {}, received.subspan(i + 1)};
    std::copy_n(received.begin() + static_cast<std::ptrdiff_t>(i) + 1, 4, answer.after.begin());
    return answer;
  }
  return {};
}

// A data block as it comes: token, bytes, CRC.
class DataReader {
 public:
  void begin(std::uint8_t* into, std::size_t length) {
    into_ = into;
    length_ = length;
    count_ = 0;
    crc_ = 0;
    state_ = State::token;
  }
  void add(std::uint8_t byte) {
    if (state_ == State::token && byte != 0xFF)
      state_ = byte == 0xFE ? State::data : State::failed;
    else if (state_ == State::data)
      take(byte);
  }
  bool whole() const { return state_ == State::whole; }
  bool failed() const { return state_ == State::failed; }
  // How many bytes to clock next.
  std::size_t wanted() const { return state_ == State::data ? length_ + 2 - count_ : 8; }

 private:
  enum class State : std::uint8_t { token, data, whole, failed };

  void take(std::uint8_t byte) {
    if (count_ < length_) into_[count_] = byte;
    crc_ = crc16_add(crc_, byte);  // over the CRC as well: 0 then
    if (++count_ == length_ + 2) state_ = crc_ == 0 ? State::whole : State::failed;
  }

  std::uint8_t* into_ = nullptr;
  std::size_t length_ = 0, count_ = 0;
  std::uint16_t crc_ = 0;
  State state_ = State::failed;
};

// Capacity by the CSD, version 1 or 2.
inline std::uint32_t blocks_of(const std::array<std::uint8_t, 16>& csd) {
  if (csd[0] >> 6 == 1) {
    const std::uint32_t c_size = (csd[7] & 0x3Fu) << 16 | csd[8] << 8u | csd[9];
    return (c_size + 1) * 1024;
  }
  const std::uint32_t c_size = (csd[6] & 0x03u) << 10 | csd[7] << 2u | csd[8] >> 6u;
  const std::uint32_t multiplier = (csd[9] & 0x03u) << 1 | csd[10] >> 7u;
  const std::uint32_t block_log2 = csd[5] & 0x0Fu;
  return (c_size + 1) << (multiplier + 2 + block_log2 - 9);
}

}  // namespace fw::sd
