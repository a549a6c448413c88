#include "harness/catalogue/esc_mode.hpp"

#include <algorithm>
#include <array>

namespace whirl::catalogue {
namespace {

using fw::esc::Mode;
using io::EscMode;

constexpr EscModeWord kDefault = {"thrust_by_rpm", EscMode::thrust_by_rpm, Mode::thrust_by_speed};
constexpr std::array<EscModeWord, 5> kWords = {
    {{"duty", EscMode::duty, Mode::duty},
     {"rpm", EscMode::rpm, Mode::speed},
     kDefault,
     {"power", EscMode::power, Mode::power},
     {"thrust_by_power", EscMode::thrust_by_power, Mode::thrust_by_power}}};

}  // namespace

EscModeWord read_esc_mode(const lua::Table& t, std::string_view key) {
  std::vector<std::string> words;
  words.reserve(kWords.size());
  for (const EscModeWord& mode : kWords) words.emplace_back(mode.word);
  const std::string word = t.choice(key, words);
  const auto found = std::find_if(kWords.begin(), kWords.end(),
                                  [&](const EscModeWord& mode) { return mode.word == word; });
  return found == kWords.end() ? kDefault : *found;
}

}  // namespace whirl::catalogue
