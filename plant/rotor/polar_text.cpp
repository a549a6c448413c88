// The .polar text format, read with the line of every fault.
#include <charconv>
#include <cmath>
#include <optional>

#include "base/angles.hpp"

#include "plant/rotor/polar.hpp"

namespace whirl::plant {
namespace {

std::vector<std::string_view> words_of(std::string_view line) {
  line = line.substr(0, line.find('#'));
  std::vector<std::string_view> words;
  constexpr std::string_view kBlank = " \t\r,";
  for (auto at = line.find_first_not_of(kBlank); at != std::string_view::npos;) {
    const auto end = std::min(line.find_first_of(kBlank, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlank, end);
  }
  return words;
}

std::optional<double> number(std::string_view word) {
  double value = 0.0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return {};
  return value;
}

struct Reader {
  std::string place;
  std::string name;
  std::vector<PolarCurve> curves;
  double lift_below = 0.1;
  double drag_within = 0.0;

  Error fault(int line, std::string what, std::string cure) const {
    return {ErrorKind::bad_input, place + ":" + std::to_string(line), std::move(what),
            std::move(cure)};
  }
  std::optional<Error> read(int line, const std::vector<std::string_view>& words);
  std::optional<Error> take_below(int line, const std::vector<std::string_view>& words);
  std::optional<Error> take_within(int line, const std::vector<std::string_view>& words);
  std::optional<Error> take_row(int line, const std::vector<std::string_view>& words);
  std::optional<Error> take_reynolds(int line, const std::vector<std::string_view>& words);
  std::optional<Error> check_last(int line) const;
};

std::optional<Error> Reader::read(int line, const std::vector<std::string_view>& words) {
  if (words[0] == "section") {
    if (words.size() != 2) return fault(line, "section wants one name", "write e.g. section e63");
    name = words[1];
    return {};
  }
  if (words[0] == "below") return take_below(line, words);
  if (words[0] == "drag_within") return take_within(line, words);
  return words[0] == "reynolds" ? take_reynolds(line, words) : take_row(line, words);
}

std::optional<Error> Reader::take_below(int line, const std::vector<std::string_view>& words) {
  const auto value = words.size() == 2 ? number(words[1]) : std::nullopt;
  if (!value || !(*value >= 0.0 && *value <= 1.0)) {
    return fault(line, "below wants one number from 0 to 1", "the power of Re that lift follows");
  }
  lift_below = *value;
  return {};
}

std::optional<Error> Reader::take_within(int line, const std::vector<std::string_view>& words) {
  const auto value = words.size() == 2 ? number(words[1]) : std::nullopt;
  if (!value || !(*value >= 0.0 && *value < 1.0)) {
    return fault(line, "drag_within wants one number from 0 to below 1",
                 "the share by which drag may be off, e.g. drag_within 0.22");
  }
  drag_within = *value;
  return {};
}

std::optional<Error> Reader::take_reynolds(int line, const std::vector<std::string_view>& words) {
  if (auto bad = check_last(line)) return bad;
  const auto value = words.size() == 2 ? number(words[1]) : std::nullopt;
  if (!value || !(*value >= 1e3 && *value <= 1e8)) {
    return fault(line, "reynolds wants one number from 1e3 to 1e8", "write e.g. reynolds 60000");
  }
  if (!curves.empty() && *value <= curves.back().reynolds) {
    return fault(line, "Reynolds numbers must ascend", "sort the blocks");
  }
  curves.push_back({*value, {}});
  return {};
}

std::optional<Error> Reader::take_row(int line, const std::vector<std::string_view>& words) {
  if (curves.empty()) return fault(line, "row before the first reynolds line", "add reynolds RE");
  if (words.size() != 3) return fault(line, "a row has three numbers", "write alpha_deg cl cd");
  double v[3];
  for (int i = 0; i < 3; ++i) {
    const auto value = number(words[static_cast<std::size_t>(i)]);
    if (!value) {
      return fault(line, "'" + std::string(words[static_cast<std::size_t>(i)]) + "' is no number",
                   "write alpha_deg cl cd");
    }
    v[i] = *value;
  }
  auto& rows = curves.back().rows;
  const double alpha = v[0] * kDeg;
  if (std::abs(v[0]) > 180.0) return fault(line, "angle beyond 180 deg", "use -180 to 180 deg");
  if (!rows.empty() && alpha <= rows.back().alpha_rad) {
    return fault(line, "angles must ascend", "sort the rows of this block");
  }
  if (!(v[2] > 0.0 && v[2] < 5.0)) return fault(line, "drag must lie between 0 and 5", "");
  if (std::abs(v[1]) > 5.0) return fault(line, "lift beyond 5", "check the columns' order");
  rows.push_back({alpha, v[1], v[2]});
  return {};
}

std::optional<Error> Reader::check_last(int line) const {
  if (curves.empty() || curves.back().rows.size() >= 5) return {};
  return fault(line, "a block needs at least 5 rows", "give angles from below zero lift to stall");
}

}  // namespace

Result<PolarFamily> read_polar(std::string_view text, std::string_view place) {
  Reader reader{std::string(place), "", {}};
  int line = 0;
  while (!text.empty()) {
    const auto end = text.find('\n');
    const auto words = words_of(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    ++line;
    if (words.empty()) continue;
    if (auto bad = reader.read(line, words)) return *bad;
  }
  if (auto bad = reader.check_last(line)) return *bad;
  if (reader.curves.empty()) {
    return reader.fault(line, "no polar in this file", "give reynolds blocks of alpha_deg cl cd");
  }
  if (reader.name.empty()) reader.name = std::string(place);
  return PolarFamily(std::move(reader.name), std::move(reader.curves), reader.lift_below,
                     reader.drag_within);
}

}  // namespace whirl::plant
