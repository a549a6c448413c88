// Cuts a stream of bytes into lines of text: those of load cells, tachometers and meters.
//
//   Ends   CR, LF or both; empty lines do not count
//   First  what comes before the first end is part of a line whose beginning nobody saw: left out
//   Long   beyond kLongest a line is garbage: left out whole, and counted
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace whirl::io {

class LineCutter {
 public:
  static constexpr std::size_t kLongest = 256;

  void add(std::span<const std::uint8_t> bytes, const std::function<void(std::string_view)>& line);
  std::uint64_t left_out() const { return left_out_; }

 private:
  std::string line_;
  bool begun_ = false;  // the line's beginning was seen
  std::uint64_t left_out_ = 0;
};

// The numbers of a line: "2.013, 5012;-0.4" or "thrust 2.013 N speed=5012", in order. What is no number
// separates. A number stands alone: "N2" and "2.0.1" are none.
std::vector<double> numbers_of(std::string_view line);

}  // namespace whirl::io
