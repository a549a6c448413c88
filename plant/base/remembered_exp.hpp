// e^x - 1, remembered: steps between the edges of a PWM and a converter's samples have few lengths.
//
//   Error   none: what is remembered is what std::expm1() gave for the same bits
//   Use     one for each time constant; it forgets by its own
#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace whirl::plant {

class RememberedExp {
 public:
  double expm1(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    Entry& entry = entries_[place_of(bits)];
    if (entry.of != bits) entry = {bits, std::expm1(x)};
    return entry.value;
  }

 private:
  struct Entry {
    std::uint64_t of = 0;  // 0.0, whose value is
    double value = 0.0;
  };
  static constexpr int kBits = 7;
  static std::size_t place_of(std::uint64_t bits) {
    return (bits * 0x9E3779B97F4A7C15u) >> (64 - kBits);
  }

  std::array<Entry, std::size_t{1} << kBits> entries_{};
};

}  // namespace whirl::plant
