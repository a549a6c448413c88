#include "harness/timing/fields.hpp"

#include <charconv>
#include <cmath>

namespace whirl::timing {
namespace {

constexpr std::string_view kBlanks = " \t";

template <typename T>
std::optional<T> parsed(std::string_view word) {
  T value{};
  const char* end = word.data() + word.size();
  const auto [at, status] = std::from_chars(word.data(), end, value);
  if (status != std::errc() || at != end) return std::nullopt;
  return value;
}

}  // namespace

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

std::vector<std::string_view> words_of(std::string_view line, std::size_t most) {
  std::vector<std::string_view> words;
  for (;;) {
    const std::size_t from = line.find_first_not_of(kBlanks);
    if (from == std::string_view::npos) return words;
    line.remove_prefix(from);
    if (words.size() + 1 == most) {
      words.push_back(line.substr(0, line.find_last_not_of(kBlanks) + 1));
      return words;
    }
    const std::size_t end = line.find_first_of(kBlanks);
    words.push_back(line.substr(0, end));
    line.remove_prefix(words.back().size());
  }
}

std::optional<std::uint32_t> whole_number(std::string_view word) {
  return parsed<std::uint32_t>(word);
}

std::optional<double> finite_number(std::string_view word) {
  const auto value = parsed<double>(word);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace whirl::timing
