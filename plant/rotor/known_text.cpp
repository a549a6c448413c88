// Known blades as text: one line of words and numbers each, the spread last.
#include <charconv>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "plant/rotor/known_blades.hpp"

namespace whirl::plant {
namespace {

void put(std::string& text, double value) {
  char number[32];
  std::snprintf(number, sizeof number, " %.8g", value);
  text += number;
}

// Upper triangle, row by row.
void put(std::string& text, const TraitMatrix& m) {
  for (Eigen::Index i = 0; i < kTraits; ++i) {
    for (Eigen::Index k = i; k < kTraits; ++k) put(text, m(i, k));
  }
}

bool take(std::istringstream& words, double& value) {
  std::string word;
  if (!(words >> word)) return false;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  return fault == std::errc() && end == word.data() + word.size() && std::isfinite(value);
}

bool take(std::istringstream& words, TraitMatrix& m) {
  for (Eigen::Index i = 0; i < kTraits; ++i) {
    for (Eigen::Index k = i; k < kTraits; ++k) {
      if (!take(words, m(i, k))) return false;
      m(k, i) = m(i, k);
    }
  }
  return true;
}

template <typename Vector>
bool take_all(std::istringstream& words, Vector& v) {
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    if (!take(words, v[i])) return false;
  }
  return true;
}

}  // namespace

std::string known_text(const KnownBlades& known) {
  std::string text =
      "# Made from the measurements beside this file: `whirl validate` leaves it in "
      "results/validation.\n"
      "# blade NAME MAKE drawn|read, 8 numbers of shape, then pull and certainty of the traits\n"
      "# (plant/rotor/known_blades.hpp); at the end the spread of the traits.\n";
  for (const KnownBlade& b : known.blades()) {
    text += "blade " + b.name + " " + b.make + (b.drawn ? " drawn" : " read");
    for (const double x : b.shape) put(text, x);
    for (const double x : b.pull) put(text, x);
    put(text, b.sure);
    text += '\n';
  }
  text += "spread";
  put(text, known.spread());
  return text + '\n';
}

Result<KnownBlades> read_known(std::string_view text, std::string_view place) {
  std::vector<KnownBlade> blades;
  TraitMatrix spread = TraitMatrix::Zero();
  bool good = true, whole = false;
  int at = 0;
  std::istringstream lines{std::string(text)};
  for (std::string line; good && std::getline(lines, line);) {
    ++at;
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string kind, how;
    words >> kind;
    if (kind == "spread") {
      good = whole = take(words, spread);
      continue;
    }
    KnownBlade& b = blades.emplace_back();
    words >> b.name >> b.make >> how;
    b.drawn = how == "drawn";
    good = kind == "blade" && take_all(words, b.shape) && take_all(words, b.pull) &&
           take(words, b.sure);
  }
  if (!good || !whole || blades.empty()) {
    return Error{ErrorKind::bad_input, std::string(place) + ":" + std::to_string(at),
                 "is no list of known blades", "check out plant/data/propellers/known.txt again"};
  }
  return KnownBlades(std::move(blades), spread);
}

}  // namespace whirl::plant
