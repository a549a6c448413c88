#include "harness/plan/timing_window.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "harness/plan/needs.hpp"
#include "harness/plan/raise.hpp"

namespace whirl::plan {

std::string in_text(double x_s, const std::string& unit) {
  if (std::abs(x_s) < 1e-12) x_s = 0.0;  // times are whole nanoseconds
  char text[48];
  std::snprintf(text, sizeof text, "%.4g %s", in_unit(x_s, unit), unit.c_str());
  return text;
}

std::string spread(const metrics::Distribution& d, const std::string& unit) {
  if (d.count == 0) return "nothing to measure";
  if (std::isnan(d.max)) return "not known of each of " + std::to_string(d.count) + " values";
  return "p50 " + in_text(d.p50, unit) + ", p99 " + in_text(d.p99, unit) + ", " +
         std::to_string(d.count) + " values";
}

std::optional<Limit> optional_limit(const lua::Table& given, const char* key, Dimension dimension,
                                    const lua::Range& range) {
  if (!given.has(key)) return std::nullopt;
  return Limit{given.quantity(key, dimension, range), unit_symbol(given.text(key))};
}

std::optional<Limit> optional_period(const lua::Table& given) {
  return optional_limit(given, "period", Dimension::time, lua::above(0.0));
}

std::int64_t window_end(Script& self, const lua::Table& given) {
  constexpr std::size_t kMost_windows = 1'000;
  if (self.windows() >= kMost_windows) given.refuse("during", "more than 1000 budgets");
  return given.has("during") ? self.stage().now_ns + given.duration_ns("during") : kForever;
}

std::vector<double> deviations(std::span<const std::int64_t> times, std::int64_t from,
                               std::int64_t to, double nominal_s, double tolerance_s) {
  constexpr double kSlack_s = 1e-11;  // times are whole nanoseconds
  if (times.empty() && seconds(to - from) - nominal_s <= tolerance_s + kSlack_s) return {};
  std::vector<double> all = metrics::deviations_s(metrics::periods_s(times), nominal_s);
  const double head = seconds((times.empty() ? to : times.front()) - from);
  const double tail = seconds(to - (times.empty() ? from : times.back()));
  for (double gap : {head, tail}) {
    if (gap > nominal_s) all.push_back(gap - nominal_s);
  }
  return all;
}

void judge_spread(Script& self, std::span<const double> values, const Limit& limit,
                  const std::string& name, const std::string& place, std::int64_t to_ns,
                  Script::Figure figure) {
  const auto d = metrics::distribution(values);
  self.judge_in_window({d.max, Dimension::time, name}, figure, limit, place, seconds(to_ns),
                       spread(d, limit.unit));
}

NodePlace node_at(lua_State* L, Script& self, const std::string& text) {
  const auto place = node_place(self.stage().nodes, text);
  if (!place) raise(L, place.error().what, place.error().cure);
  return place.value();
}

void must_offer(lua_State* L, Script& self, const std::string& call) {
  for (const Offer offer : needs_of_call(call)) {
    if (self.stage().offers.has(offer)) continue;
    raise(L, not_offered("t:" + call, offer));
  }
}

void must_see(lua_State* L, Script& self, const std::string& wires) {
  if (!self.stage().sees || self.stage().sees(wires)) return;
  raise(L, "no clip of the bench's analyser is on " + wires,
        "analyser = { channels = ... } of the bench's file");
}

bool unread_between(const results::EventLog& log, bool spi, int bus, std::int64_t from,
                    std::int64_t to) {
  return std::any_of(log.unread.begin(), log.unread.end(), [&](const results::UnreadRecord& u) {
    return u.spi == spi && u.bus == bus && u.stop_ns >= from && u.start_ns <= to;
  });
}

}  // namespace whirl::plan
