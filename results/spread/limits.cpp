#include "results/spread/limits.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "base/text.hpp"
#include "results/spread/sums.hpp"

namespace whirl::results {
namespace {

struct Measured {
  ProposedLimit limit;
  std::set<std::string> names;
  Sums sums;
  bool usable = true;
};

std::string shown(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

double rounded(double x, double step, bool up) {
  return (up ? std::ceil(x / step - 1e-9) : std::floor(x / step + 1e-9)) * step;
}

double two_digits(double x, bool up) {
  return rounded(x, std::pow(10.0, std::floor(std::log10(std::abs(x))) - 1.0), up);
}

void add(const Expectation& e, std::uint64_t seed, Measured& m) {
  ProposedLimit& p = m.limit;
  const bool first = m.names.empty();
  m.names.insert(e.name);
  m.usable = m.usable && std::isfinite(e.measured) &&
             (e.how == "at most" || e.how == "at least" || e.how == "within");
  if (first) {
    p.place = e.place, p.name = e.name, p.unit = e.unit, p.how = e.how, p.low = e.low,
    p.high = e.high;
    p.lowest = p.highest = e.measured, p.lowest_seed = p.highest_seed = seed;
  }
  m.usable = m.usable && e.unit == p.unit && e.how == p.how;
  if (!m.usable) return;
  m.sums.add(e.measured);
  // Limits that the plan computes may differ: the loosest is what the line lets pass.
  if (e.high && p.high) p.high = std::max(*p.high, *e.high);
  if (e.low && p.low) p.low = std::min(*p.low, *e.low);
  if (e.measured < p.lowest) {
    p.lowest = e.measured, p.lowest_seed = seed;
    if (e.how == "at least") p.name = e.name;
  }
  if (e.measured > p.highest) {
    p.highest = e.measured, p.highest_seed = seed;
    if (e.how != "at least") p.name = e.name;
  }
}

void propose(const Measured& m, double margin, ProposedLimit& p) {
  if (p.how == "at most" && p.highest != 0.0) {
    p.high_proposed = two_digits(p.highest + margin * std::abs(p.highest), true);
  } else if (p.how == "at least" && p.lowest != 0.0) {
    p.low_proposed = two_digits(p.lowest - margin * std::abs(p.lowest), false);
  } else if (p.how == "within") {
    const double away = margin * std::max(p.highest - p.lowest, 3.0 * m.sums.sigma());
    if (m.sums.n < 2 || away == 0.0) return;
    const double width = p.highest - p.lowest + 2.0 * away;
    const double step = std::pow(10.0, std::floor(std::log10(width)) - 1.0);
    p.low_proposed = rounded(p.lowest - away, step, false);
    p.high_proposed = rounded(p.highest + away, step, true);
  }
}

std::string with_unit(double x, const std::string& unit) {
  return shown(x) + (unit.empty() ? "" : " " + unit);
}

std::string words(const std::string& how, const std::optional<double>& low,
                  const std::optional<double>& high, const std::string& unit) {
  if (how == "within" && low && high) {
    return "within " + with_unit(*low, unit) + ".." + with_unit(*high, unit);
  }
  const auto& limit = how == "at most" ? high : low;
  return limit ? how + " " + with_unit(*limit, unit) : "-";
}

std::string line_of(const ProposedLimit& p) {
  const bool low = p.how == "at least";
  std::string worst =
      low ? with_unit(p.lowest, p.unit) + " (seed " + std::to_string(p.lowest_seed) + ")"
          : with_unit(p.highest, p.unit) + " (seed " + std::to_string(p.highest_seed) + ")";
  if (p.how == "within") worst = with_unit(p.lowest, p.unit) + ".." + with_unit(p.highest, p.unit);
  const std::string more = p.judged > 1 ? " and " + std::to_string(p.judged - 1) + " more" : "";
  return "  " + p.place + "  " + printable_line(p.name) + more + "\n      measured " + worst +
         "; now " + words(p.how, p.low, p.high, p.unit) + "; proposed " +
         words(p.how, p.low_proposed, p.high_proposed, p.unit) + "\n";
}

}  // namespace

std::vector<ProposedLimit> propose_limits(const std::vector<const SeedRun*>& runs, double margin) {
  std::map<std::string, std::size_t> at;  // in the order of the plan
  std::vector<Measured> all;
  for (const SeedRun* run : runs) {
    for (const Expectation& e : run->report.expectations) {
      const auto [found, is_new] = at.emplace(e.place + "\n" + e.how + "\n" + e.unit, all.size());
      if (is_new) all.emplace_back();
      add(e, run->report.seed, all[found->second]);
    }
  }
  std::vector<ProposedLimit> limits;
  for (Measured& m : all) {
    if (!m.usable) continue;
    m.limit.judged = m.names.size();
    propose(m, margin, m.limit);
    if (m.limit.low_proposed || m.limit.high_proposed) limits.push_back(m.limit);
  }
  return limits;
}

std::string limits_text(const std::vector<ProposedLimit>& limits, double margin) {
  std::string text =
      "limits proposed from the worst that was measured and " + shown(100.0 * margin) + " %:\n";
  for (const ProposedLimit& p : limits) text += line_of(p);
  return text;
}

}  // namespace whirl::results
