// ULog messages, the log format of PX4's tools: what one consists of, and a buffer to put it together in.
//
//   Layout  three bytes of head (size without them, type), then fields packed without gaps, little-endian.
//           No format here ends in padding: readers disagree on whether that is written
//   Source  PX4 Developer Guide, "ULog File Format", version 1
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace fw::ulog {

enum class Type : char {
  flag_bits = 'B',
  format = 'F',
  info = 'I',
  parameter = 'P',
  subscribe = 'A',
  data = 'D',
  text = 'L',
  dropout = 'O',
};

enum class Level : char { critical = '2', warning = '4', info = '6' };

inline constexpr std::size_t kHead_bytes = 3, kFileHead_bytes = 16;

// The first bytes of a file.
inline std::array<std::uint8_t, kFileHead_bytes> file_head(std::uint64_t start_us) {
  std::array<std::uint8_t, kFileHead_bytes> bytes{0x55, 0x4C, 0x6F, 0x67, 0x01, 0x12, 0x35, 1};
  std::memcpy(bytes.data() + 8, &start_us, sizeof start_us);
  return bytes;
}

class Message {
 public:
  static constexpr std::size_t kMost_bytes = 320;

  explicit Message(Type type) { bytes_[2] = static_cast<std::uint8_t>(type); }

  // What does not fit is left out, and ok() says so.
  template <typename T>
  Message& put(const T& value) {
    return add(&value, sizeof value);
  }
  Message& text(std::string_view words) { return add(words.data(), words.size()); }
  // A key of an information or parameter: its length, then "type name".
  Message& key(std::string_view type, std::string_view name) {
    const std::size_t length = type.size() + 1 + name.size();
    return put(static_cast<std::uint8_t>(length)).text(type).text(" ").text(name);
  }

  bool ok() const { return ok_; }
  std::span<const std::uint8_t> bytes() {
    const auto size = static_cast<std::uint16_t>(length_ - kHead_bytes);
    std::memcpy(bytes_.data(), &size, sizeof size);
    return std::span(bytes_).first(length_);
  }

 private:
  Message& add(const void* from, std::size_t count) {
    ok_ = ok_ && length_ + count <= kMost_bytes;
    if (!ok_) return *this;
    std::memcpy(bytes_.data() + length_, from, count);
    length_ += count;
    return *this;
  }

  std::array<std::uint8_t, kMost_bytes> bytes_;  // as far as length_ says
  std::size_t length_ = kHead_bytes;
  bool ok_ = true;
};

// A text as a value of an information: "char[N] name".
inline Message text_info(std::string_view name, std::string_view words) {
  std::array<char, 12> type{"char["};
  std::size_t at = 5;
  if (words.size() >= 10) type[at++] = static_cast<char>('0' + words.size() / 10 % 10);
  type[at++] = static_cast<char>('0' + words.size() % 10);
  type[at++] = ']';
  return Message(Type::info).key({type.data(), at}, name).text(words);
}

}  // namespace fw::ulog
