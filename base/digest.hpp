// A 64-bit digest (FNV-1a) of a sequence of bytes: tells runs apart, is not a signature.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

namespace whirl {

class Digest {
 public:
  void add_bytes(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 1099511628211u;
  }
  void add(std::int64_t number) { add_bytes(&number, sizeof number); }

  std::uint64_t value() const { return value_; }
  std::string hex() const {
    static constexpr char kDigits[] = "0123456789abcdef";
    std::string text(16, '0');
    for (int i = 0; i < 16; ++i) text[i] = kDigits[(value_ >> (60 - 4 * i)) & 15];
    return text;
  }

 private:
  std::uint64_t value_ = 14695981039346656037u;
};

}  // namespace whirl
