#include "results/spread/spread.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "base/text.hpp"
#include "results/spread/same_expectation.hpp"
#include "results/spread/sums.hpp"

namespace whirl::results {
namespace {

std::string number(double x, const char* format = "%.4g") {
  if (std::isnan(x)) return "-";
  char text[40];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

void add(const Expectation& e, std::uint64_t seed, SpreadRow& row, Sums& sums) {
  if (row.runs == 0) {
    row.unit = e.unit;
    row.limit = e.limit_text();
    row.lowest = row.highest = row.least_margin = std::nan("");
  } else if (row.limit != e.limit_text() && !row.limit.ends_with(" ...")) {
    row.limit += " ...";
  }
  ++row.runs;
  row.met += e.verdict == Verdict::pass ? 1 : 0;
  row.numbers = row.numbers || e.how != "holds";
  if (!std::isfinite(e.measured)) return;
  sums.add(e.measured);
  if (!(e.measured >= row.lowest)) row.lowest = e.measured, row.lowest_seed = seed;
  if (!(e.measured <= row.highest)) row.highest = e.measured, row.highest_seed = seed;
  if (!(e.margin >= row.least_margin)) row.least_margin = e.margin, row.least_margin_seed = seed;
}

void conclude(const Sums& sums, SpreadRow& row) {
  row.mean = sums.n > 0 ? sums.mean : std::nan("");
  row.sigma = sums.sigma();
}

std::vector<const SeedRun*> by_seed(std::vector<const SeedRun*> runs) {
  std::stable_sort(runs.begin(), runs.end(), [](const SeedRun* a, const SeedRun* b) {
    return a->report.seed < b->report.seed;
  });
  return runs;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : legal_text(text)) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

// Of all runs: one that did not come so far did not meet it.
std::string met(const SpreadRow& row, const Spread& spread) {
  return std::to_string(row.met) + "/" + std::to_string(spread.runs);
}

std::string with_seed(double x, std::uint64_t seed) {
  return std::isnan(x) ? "-" : number(x) + " (" + std::to_string(seed) + ")";
}

}  // namespace

Spread spread_of(const std::vector<const SeedRun*>& runs) {
  Spread all;
  std::vector<Sums> sums;
  std::map<std::string, std::size_t> places;
  for (const SeedRun* run : by_seed(runs)) {
    const Report& report = run->report;
    all.plan = report.plan;
    all.file = report.file;
    all.seeds.push_back(report.seed);
    ++all.runs;
    all.passed += report.verdict == Verdict::pass ? 1 : 0;
    SameExpectation names;
    for (const Expectation& e : report.expectations) {
      const std::string name = names.name(e);
      const auto [at, is_new] = places.emplace(name, all.rows.size());
      if (is_new) {
        all.rows.emplace_back().name = name;
        sums.emplace_back();
      }
      add(e, report.seed, all.rows[at->second], sums[at->second]);
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) conclude(sums[i], all.rows[i]);
  return all;
}

std::string spread_text(const Spread& spread) {
  std::string text = spread.plan + " on " + std::to_string(spread.runs) +
                     " seeds: " + std::to_string(spread.passed) + " passed\n";
  text = printable_line(text.substr(0, text.size() - 1)) + "\n";
  char line[400];
  std::snprintf(line, sizeof line, "  %-5s %-52s %10s %9s  %-16s %-16s %-18s %s\n", "met", "",
                "mean", "sigma", "lowest (seed)", "highest (seed)", "margin (seed)", "wanted");
  text += line;
  for (const SpreadRow& row : spread.rows) {
    if (!row.numbers && row.met == spread.runs) continue;
    std::snprintf(line, sizeof line, "  %-5s %-52.52s %10s %9s  %-16s %-16s %-18s ",
                  met(row, spread).c_str(), printable_line(row.name).c_str(),
                  number(row.mean).c_str(), number(row.sigma, "%.3g").c_str(),
                  with_seed(row.lowest, row.lowest_seed).c_str(),
                  with_seed(row.highest, row.highest_seed).c_str(),
                  with_seed(row.least_margin, row.least_margin_seed).c_str());
    text += line + printable_line(row.limit) + "\n";
  }
  return text;
}

std::string spread_csv(const std::vector<const SeedRun*>& runs) {
  std::string text = "expectation,seed,measured,unit,wanted,margin,verdict\n";
  for (const SeedRun* run : by_seed(runs)) {
    SameExpectation names;
    for (const Expectation& e : run->report.expectations) {
      const auto value = [](double x) { return std::isfinite(x) ? number(x, "%.9g") : ""; };
      text += quoted(names.name(e)) + "," + std::to_string(run->report.seed) + "," +
              value(e.measured) + "," + quoted(e.unit) + "," + quoted(e.limit_text()) + "," +
              value(e.margin) + "," + name(e.verdict) + "\n";
    }
  }
  return text;
}

std::string spread_html(const Spread& spread, const std::vector<Chart>& charts) {
  ChartTable table{"Expectations",
                   {{"", false},
                    {"met", true},
                    {"mean", true},
                    {"sigma", true},
                    {"lowest (seed)", true},
                    {"highest (seed)", true},
                    {"least margin (seed)", true},
                    {"wanted", false}},
                   {}};
  for (const SpreadRow& row : spread.rows) {
    table.rows.push_back({row.name, met(row, spread), number(row.mean), number(row.sigma, "%.3g"),
                          with_seed(row.lowest, row.lowest_seed),
                          with_seed(row.highest, row.highest_seed),
                          with_seed(row.least_margin, row.least_margin_seed), row.limit});
  }
  const std::string about = std::to_string(spread.passed) + " of " + std::to_string(spread.runs) +
                            " seeds passed; " + spread.file;
  return charts_html(spread.plan, about, charts, {table});
}

}  // namespace whirl::results
