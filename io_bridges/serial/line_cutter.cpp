#include "io_bridges/serial/line_cutter.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace whirl::io {

void LineCutter::add(std::span<const std::uint8_t> bytes,
                     const std::function<void(std::string_view)>& line) {
  for (const std::uint8_t byte : bytes) {
    if (byte != '\r' && byte != '\n') {
      if (line_.size() <= kLongest) line_ += static_cast<char>(byte);
      continue;
    }
    if (line_.size() > kLongest) {
      ++left_out_;
    } else if (begun_ && !line_.empty()) {
      line(line_);
    }
    begun_ = true;
    line_.clear();
  }
}

std::vector<double> numbers_of(std::string_view line) {
  constexpr std::string_view kBetween = " \t,;:=|";
  std::vector<double> numbers;
  while (!line.empty()) {
    const std::size_t end = std::min(line.find_first_of(kBetween), line.size());
    std::string_view word = line.substr(0, end);
    line.remove_prefix(std::min(end + 1, line.size()));
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0.0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool whole = error == std::errc{} && stop == word.data() + word.size();
    if (whole && std::isfinite(value)) numbers.push_back(value);
  }
  return numbers;
}

}  // namespace whirl::io
