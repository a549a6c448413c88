// A row of doubles as bytes that compress: each XORed with its column's last, then by significance.
#pragma once
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace whirl::results {

class RowCode {
 public:
  explicit RowCode(std::size_t columns) : last_(columns, 0), bytes_(columns * 8) {}

  std::span<const std::uint8_t> code(std::span<const double> row) {
    const std::size_t n = last_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const auto bits = std::bit_cast<std::uint64_t>(row[i]);
      const std::uint64_t change = bits ^ last_[i];
      last_[i] = bits;
      for (std::size_t b = 0; b < 8; ++b) {
        bytes_[b * n + i] = static_cast<std::uint8_t>(change >> (56 - 8 * b));
      }
    }
    return bytes_;
  }

  // Pre: 8 bytes for each column, and as many doubles.
  void decode(std::span<const std::uint8_t> bytes, std::span<double> row) {
    const std::size_t n = last_.size();
    for (std::size_t i = 0; i < n; ++i) {
      std::uint64_t change = 0;
      for (std::size_t b = 0; b < 8; ++b) change = change << 8 | bytes[b * n + i];
      last_[i] ^= change;
      row[i] = std::bit_cast<double>(last_[i]);
    }
  }

 private:
  std::vector<std::uint64_t> last_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace whirl::results
