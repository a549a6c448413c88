#include "results/parity.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace whirl::results {
namespace {

ParityRow row_of(const Expectation& e) {
  ParityRow row{.name = e.name, .unit = e.unit, .limit = e.limit_text()};
  row.first = row.second = row.difference = std::nan("");
  return row;
}

std::string number(double x) {
  if (std::isnan(x)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", x);
  return text;
}

std::string percent(double share) {
  if (std::isnan(share)) return "-";
  if (std::isinf(share)) return "from 0";
  char text[32];
  std::snprintf(text, sizeof text, "%+.2f %%", share * 100.0);
  return text;
}

std::string met(const ParityRow& row) {
  if (!row.in_both) return "only one has it";
  if (row.first_met && row.second_met) return "both";
  if (row.first_met || row.second_met) return row.first_met ? "first only" : "second only";
  return "neither";
}

std::string marked(const ParityRow& row) {
  return percent(row.difference) + (row.marked() ? " *" : "");
}

double difference(double first, double second) {
  const double apart = second - first;
  if (first == 0.0 && apart == 0.0) return 0.0;
  return apart / std::abs(first);
}

std::string limits(const ParityRow& row) {
  return row.limits_differ() ? row.limit + "; second: " + row.second_limit + " *" : row.limit;
}

std::string named(const Report& report) {
  int images = 0;
  for (const auto& [what, version] : report.versions) {
    if (what == "bench") return version;
    if (what.ends_with("/image")) ++images;
  }
  return images > 1 ? std::to_string(images) + " virtual boards" : "virtual board";
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace

std::vector<ParityRow> parity(const Report& first, const Report& second) {
  std::vector<ParityRow> rows;
  std::vector<bool> paired(second.expectations.size());
  for (const Expectation& a : first.expectations) {
    ParityRow row = row_of(a);
    row.first = a.measured;
    row.first_met = a.verdict == Verdict::pass;
    for (std::size_t i = 0; i < paired.size(); ++i) {
      const Expectation& b = second.expectations[i];
      if (paired[i] || b.name != a.name) continue;
      paired[i] = row.in_both = true;
      row.second = b.measured;
      row.second_met = b.verdict == Verdict::pass;
      row.difference = difference(a.measured, b.measured);
      if (b.limit_text() != a.limit_text()) row.second_limit = b.limit_text();
      break;
    }
    rows.push_back(std::move(row));
  }
  for (std::size_t i = 0; i < paired.size(); ++i) {
    if (paired[i]) continue;
    ParityRow row = row_of(second.expectations[i]);
    row.second = second.expectations[i].measured;
    row.second_met = second.expectations[i].verdict == Verdict::pass;
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string parity_text(const Report& first, const Report& second) {
  std::string text = first.plan + ": " + named(first) + " (" + name(first.verdict) + ") beside " +
                     named(second) + " (" + name(second.verdict) + ")\n";
  char line[600];
  std::snprintf(line, sizeof line, "  %-44s %10s %10s %11s  %-16s %s\n", "", "first", "second",
                "differ", "limit met by", "limit");
  text += line;
  for (const ParityRow& row : parity(first, second)) {
    std::snprintf(line, sizeof line, "  %-44.44s %10s %10s %11s  %-16s %s\n", row.name.c_str(),
                  number(row.first).c_str(), number(row.second).c_str(), marked(row).c_str(),
                  met(row).c_str(), limits(row).c_str());
    text += line;
  }
  return text;
}

std::string parity_page(const Report& first, const Report& second) {
  std::string page =
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>" + escaped(first.plan) +
      "</title><style>body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;max-width:70em;"
      "padding:0 1em}table{border-collapse:collapse}td,th{padding:.25em .8em;text-align:right;"
      "border-bottom:1px solid #ddd}td:first-child,th:first-child,td:last-child,th:last-child"
      "{text-align:left}.no{color:#b00020;font-weight:600}</style><h1>" +
      escaped(first.plan) + "</h1><p>First: " + escaped(named(first)) + ", " + name(first.verdict) +
      ". Second: " + escaped(named(second)) + ", " + name(second.verdict) +
      (second.reason.empty() ? "" : " (" + escaped(second.reason) + ")") +
      ". Differences of more than 5 % are "
      "marked, and limits that are not the "
      "same.</p><table><tr><th>Figure<th>First<th>Second<th>Difference<th>Limit met by<th>Limit";
  for (const ParityRow& row : parity(first, second)) {
    const std::string by = met(row);
    page += "<tr><td>" + escaped(row.name) + "<td>" + number(row.first) + "<td>" +
            number(row.second) + "<td" + (row.marked() ? " class=\"no\"" : "") + ">" + marked(row) +
            "<td" + (by == "both" ? "" : " class=\"no\"") + ">" + by + "<td" +
            (row.limits_differ() ? " class=\"no\"" : "") + ">" + escaped(limits(row));
  }
  return page + "</table></html>\n";
}

}  // namespace whirl::results
