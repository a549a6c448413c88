#include "harness/cli/seeds.hpp"

#include <charconv>
#include <set>

namespace whirl::cli {
namespace {

Error wrong(const std::string& what) {
  return {ErrorKind::bad_input, "", what, ""};
}

std::string words_for_most() {
  return "more than " + std::to_string(kMost_seeds) + " seeds";
}

Result<Done> add_range(const std::string& text, std::vector<std::uint64_t>& seeds) {
  const auto dots = text.find("..");
  const auto first = read_seed(text.substr(0, dots));
  if (!first) return first.error();
  const auto last = dots == std::string::npos ? first : read_seed(text.substr(dots + 2));
  if (!last) return last.error();
  if (last.value() < first.value()) return wrong("'" + text + "' ends before it begins");
  if (last.value() - first.value() >= kMost_seeds)
    return wrong("'" + text + "' is " + words_for_most());
  for (std::uint64_t n = 0; n <= last.value() - first.value(); ++n) {
    seeds.push_back(first.value() + n);
  }
  return Done{};
}

}  // namespace

// CLI11 would make something of "-1" and of nothing.
Result<std::uint64_t> read_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (status == std::errc() && end == text.data() + text.size() && !text.empty()) return seed;
  return wrong("'" + text + "' is no seed (0 to 18446744073709551615)");
}

Result<std::vector<std::uint64_t>> read_seeds(const std::string& text) {
  std::vector<std::uint64_t> seeds;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const auto added = add_range(text.substr(at, comma - at), seeds);
    if (!added) return added.error();
    if (seeds.size() > kMost_seeds) return wrong("'" + text + "' is " + words_for_most());
    at = comma + 1;
  }
  std::set<std::uint64_t> seen;
  for (const std::uint64_t seed : seeds) {
    if (!seen.insert(seed).second) {
      return wrong("'" + text + "' has the seed " + std::to_string(seed) + " twice");
    }
  }
  return seeds;
}

}  // namespace whirl::cli
