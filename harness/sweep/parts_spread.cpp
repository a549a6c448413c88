#include "harness/sweep/parts_spread.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/check.hpp"

namespace whirl::sweep {
namespace {

constexpr const char* kHeads[] = {"group", "number", "unit", "copies", "mean",  "sigma",
                                  "least", "most",   "from", "to",     "source"};
constexpr std::size_t kFirst_figure = 3, kSource = 10;

// "motor 3 resistance" is the resistance of each motor.
bool is(const std::string& drawn, const std::string& name) {
  return drawn == name || (drawn.size() > name.size() && drawn.ends_with(name) &&
                           drawn[drawn.size() - name.size() - 1] == ' ');
}

std::string figure(double x) {
  if (std::isnan(x)) return "-";
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

std::vector<std::string> cells(const NumberSpread& row) {
  const plant::PartNumber& number = *row.number;
  const std::string unit = number.of_nominal   ? "of its own"
                           : *number.unit == 0 ? "share"
                                               : number.unit;
  return {number.group,
          number.name,
          unit,
          std::to_string(row.sums.n),
          figure(row.sums.mean),
          figure(row.sums.sigma()),
          figure(row.least),
          figure(row.most),
          figure(row.allowed.low),
          figure(row.allowed.high),
          number.source};
}

}  // namespace

PartsSpread::PartsSpread(const std::vector<const plant::PartNumber*>& numbers,
                         const plant::Tolerances& tolerance) {
  for (const plant::PartNumber* number : numbers) {
    const auto chosen = tolerance.find(number->group);
    if (chosen == tolerance.end() || chosen->second == plant::ToleranceClass::none) continue;
    rows_.push_back({number, plant::bounds(number->spread, chosen->second)});
  }
}

void PartsSpread::add(const std::string& drawn, double value) {
  const auto row = std::find_if(rows_.begin(), rows_.end(), [&drawn](const NumberSpread& each) {
    return is(drawn, each.number->name);
  });
  WHIRL_CHECK(row != rows_.end(), drawn);
  row->sums.add(value);
  row->least = std::min(row->least, value);
  row->most = std::max(row->most, value);
}

std::vector<NumberSpread> PartsSpread::rows() const {
  std::vector<NumberSpread> drawn;
  std::copy_if(rows_.begin(), rows_.end(), std::back_inserter(drawn),
               [](const NumberSpread& row) { return row.sums.n > 0; });
  return drawn;
}

results::ChartTable PartsSpread::table() const {
  results::ChartTable table{"What the copies are", {}, {}};
  for (std::size_t i = 0; i < std::size(kHeads); ++i) {
    table.heads.push_back({kHeads[i], i >= kFirst_figure && i < kSource});
  }
  for (const NumberSpread& row : rows()) table.rows.push_back(cells(row));
  return table;
}

std::string PartsSpread::text() const {
  const auto line = [](const std::vector<std::string>& words) {
    char text[300];
    std::snprintf(text, sizeof text, "  %-12s %-28s %-10s %7s %10s %10s %10s %10s %10s %10s\n",
                  words[0].c_str(), words[1].c_str(), words[2].c_str(), words[3].c_str(),
                  words[4].c_str(), words[5].c_str(), words[6].c_str(), words[7].c_str(),
                  words[8].c_str(), words[9].c_str());
    return std::string(text);
  };
  std::string all = line({std::begin(kHeads), std::end(kHeads)});
  for (const NumberSpread& row : rows()) all += line(cells(row));
  return all;
}

std::string PartsSpread::csv() const {
  std::string all = "group;number;unit;copies;mean;sigma;least;most;allowed_low;allowed_high\n";
  for (const NumberSpread& row : rows()) {
    const auto words = cells(row);
    for (std::size_t i = 0; i < kSource; ++i) all += (i ? ";" : "") + words[i];
    all += '\n';
  }
  return all;
}

}  // namespace whirl::sweep
