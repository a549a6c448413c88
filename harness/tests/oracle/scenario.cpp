#include "harness/tests/oracle/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

namespace whirl::oracle {
namespace {

struct Weighted {
  Clause add;
  int weight;
};

constexpr Weighted kAll[] = {
    {add_step_record, 6},  {add_statistics, 4},      {add_distance, 2},   {add_numbers, 2},
    {add_values, 2},       {add_within, 2},          {add_wait_until, 1}, {add_ask, 2},
    {add_signal_guard, 4}, {add_condition_guard, 3}, {add_budget, 5},     {add_busy, 1},
    {add_bus, 4},          {add_latency, 2},         {add_fault, 2},      {add_unlimited, 1},
};

Clause any_clause(Dice& dice) {
  int sum = 0;
  for (const Weighted& w : kAll) sum += w.weight;
  int at = dice.between(0, sum - 1);
  for (const Weighted& w : kAll) {
    if ((at -= w.weight) < 0) return w.add;
  }
  return kAll[0].add;
}

const std::vector<Ending>& endings() {
  static const std::vector<Ending> all{Ending::lua_error,     Ending::times_out,
                                       Ending::core_fault,    Ending::core_fault_with_late_host,
                                       Ending::watchdog,      Ending::watchdog_allowed,
                                       Ending::locks_up,      Ending::switches_off,
                                       Ending::late_host,     Ending::late_host,
                                       Ending::lost_target,   Ending::cut_batch,
                                       Ending::no_start_host, Ending::no_start_image};
  return all;
}

void choose_ending(Scenario& s, Dice& dice) {
  s.ending = dice.chance(0.6) ? Ending::returns : dice.pick(endings());
  if (s.ending == Ending::lua_error) s.say("error('the author is wrong')");
  s.timeout_ms = 600'000;
  const bool short_run = s.now_ms < 3;
  if (short_run && s.ending != Ending::lua_error) s.ending = Ending::returns;
  s.ending_ms = short_run ? 0 : dice.between(2, s.now_ms - 1);
  if (s.ending == Ending::times_out) s.timeout_ms = s.ending_ms;
}

}  // namespace

const Quality& any_quality(Dice& dice) {
  static const std::vector<Quality> all{
      {Dimension::length, "_m", {{"m"}, {"cm", 0.01}, {"mm", 0.001}}},
      {Dimension::force, "_N", {{"N"}, {"mN", 0.001}}},
      {Dimension::speed, "_mps", {{"m/s"}, {"km/h", 1.0 / 3.6}}},
      {Dimension::angle, "_rad", {{"rad"}, {"deg", std::numbers::pi / 180.0}}},
      {Dimension::temperature, "_K", {{"K"}, {"degC", 1.0, 273.15}}},
      {Dimension::voltage, "_V", {{"V"}, {"mV", 0.001}}}};
  return dice.pick(all);
}

const Quality& bare() {
  static const Quality quality{Dimension::none, "", {{""}}};
  return quality;
}
const Quality& ratio() {
  static const Quality quality{Dimension::ratio, "", {{"%", 0.01}}};
  return quality;
}
const Quality& duration() {
  static const Quality quality{
      Dimension::time, "_s", {{"s"}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}}};
  return quality;
}

namespace {

std::string digits(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

std::string written(const std::string& number, const Unit& unit) {
  return unit.symbol.empty() ? number : "\"" + number + " " + unit.symbol + "\"";
}

struct Bound {
  double low_SI = -kAnything, high_SI = kAnything;
  Unit unit;

  Told judge(const std::string& name, double x, double tolerance_SI) const {
    Told told{name, Right::fail, unit.of_SI(x), kNaN, 0.0};
    told.margin = std::min(x - low_SI, high_SI - x) / unit.scale;
    told.tolerance = tolerance_SI / unit.scale + 1e-9 * std::abs(told.measured) + 1e-12;
    if (x >= low_SI && x <= high_SI) told.right = Right::pass;
    if (std::isnan(x)) told.margin = kNaN;
    return told;
  }
};

Limited limited(const std::string& lua, const Bound& bound) {
  return {lua, [bound](const std::string& name, double x, double tolerance_SI) {
            return bound.judge(name, x, tolerance_SI);
          }};
}

}  // namespace

Limited most_near(Dice& dice, const Quality& quality, double x, double tolerance_SI) {
  const double at = std::isnan(x) ? 1e-3 : x;
  Bound bound;
  bound.unit = dice.pick(quality.units);
  const double gap = std::max(at, 1e-6) * dice.pick<double>({1e-3, 0.3}) + 4 * tolerance_SI;
  const std::string number =
      digits(bound.unit.of_SI(dice.chance(0.93) || at < gap ? at + gap : at - gap));
  bound.high_SI = std::strtod(number.c_str(), nullptr) * bound.unit.scale;
  return limited(written(number, bound.unit), bound);
}

Limited limit_near(Dice& dice, const Quality& quality, double x, double tolerance_SI, bool exact) {
  const double at = std::isnan(x) ? 1.0 : x;
  const bool upon = exact && dice.chance(0.3);
  Bound bound;
  bound.unit = upon ? quality.units.front() : dice.pick(quality.units);
  const double gap =
      std::max(std::abs(at), 1e-3) * dice.pick<double>({1e-6, 1e-3, 0.3}) + 4 * tolerance_SI;
  const auto text = [&](double sign) {
    return digits(bound.unit.of_SI(upon ? at : at + sign * gap));
  };
  const auto value = [&](const std::string& number) {
    return std::strtod(number.c_str(), nullptr) * bound.unit.scale + bound.unit.offset;
  };
  const double side = dice.chance(0.93) ? 1.0 : -1.0;  // met, or missed
  const int how = dice.between(0, upon || dice.chance(0.05) ? 3 : 2);
  if (how == 0 || how == 1) {
    const std::string number = text(how == 0 ? side : -side);
    (how == 0 ? bound.high_SI : bound.low_SI) = value(number);
    return limited((how == 0 ? ":at_most(" : ":at_least(") + written(number, bound.unit) + ")",
                   bound);
  }
  if (how == 2) {
    const std::string low = text(-side), high = digits(bound.unit.of_SI(at + 3 * gap));
    bound.low_SI = value(low);
    bound.high_SI = value(high);
    return limited(":within(" + written(low, bound.unit) + ", " + written(high, bound.unit) + ")",
                   bound);
  }
  const std::string number = text(1.0);
  bound.low_SI = bound.high_SI = value(number);
  return limited(":equal(" + written(number, bound.unit) + ")", bound);
}

void Scenario::wait(int ms) {
  if (ms < 1) return;
  say("t:wait \"" + std::to_string(ms) + " ms\"");
  now_ms += ms;
}

void Scenario::add_heartbeat() {
  for (int ms = 0; ms < now_ms; ms += 10) {
    const std::int64_t t_ns = ms * kMs + 123'456;
    messages.push_back({t_ns, [t_ns](io::Batch& batch) {
                          const std::uint8_t byte = 0x55;
                          batch.add(io::Kind::uart_received, 1, t_ns, &byte, 1);
                        }});
  }
}

// What comes from outside is seen after its step; the script had its last turn one step before.
End Scenario::end() const {
  switch (ending) {
    case Ending::returns:
    case Ending::lua_error:
    case Ending::watchdog_allowed:
      return {now_ms, now_ms, now_ms, ending != Ending::lua_error};
    case Ending::times_out:
    case Ending::core_fault:
    case Ending::watchdog:
    case Ending::locks_up:
    case Ending::switches_off:
    case Ending::cut_batch:
      return {ending_ms, ending_ms - 1, ending_ms, false};
    case Ending::late_host:
    case Ending::lost_target:
    case Ending::core_fault_with_late_host:
      return {ending_ms - 1, ending_ms - 1, ending_ms - 1, false};
    case Ending::no_start_host:
    case Ending::no_start_image:
      return {0, -1, -1, false};
  }
  return {};
}

Scenario make_scenario(std::uint64_t seed, unsigned mask) {
  Scenario s;
  Dice shape(seed, "shape");
  const int clauses = shape.between(1, kClauses);
  for (int i = 0; i < clauses; ++i) {
    const std::string id = std::to_string(i);
    Dice dice(seed, "clause " + id);
    const Clause add = any_clause(dice);
    if (((mask >> i) & 1u) == 0) continue;
    if (dice.chance(0.3)) s.wait(dice.between(1, 250));
    s.looks = s.looks || (add != add_numbers && add != add_fault && add != add_unlimited);
    add(s, dice, "c" + id);
  }
  Dice last(seed, "ending");
  if (((mask >> kClauses) & 1u) != 0) s.wait(last.between(2, 60));
  choose_ending(s, last);
  if (((mask >> (kClauses + 1)) & 1u) == 0 && s.ending != Ending::lua_error)
    s.ending = Ending::returns;
  if (s.ending == Ending::returns) s.timeout_ms = 600'000;
  s.add_heartbeat();
  return s;
}

Outcome right_outcome(const Scenario& s) {
  Outcome outcome;
  const End end = s.end();
  for (const Judgement& judge : s.judgements) judge(end, outcome.told);
  bool failed = false, unshown = !s.looks || end.t_ms == 0;
  for (const Told& told : outcome.told) {
    failed = failed || told.right == Right::fail;
    unshown = unshown || told.right == Right::unshown;
  }
  switch (s.ending) {
    case Ending::times_out:
    case Ending::core_fault:
    case Ending::core_fault_with_late_host:
    case Ending::watchdog:
    case Ending::locks_up:
    case Ending::switches_off:
      outcome.codes = {1};
      return outcome;
    case Ending::late_host:
    case Ending::no_start_host:
      outcome.codes = {failed ? 1 : 3};
      return outcome;
    case Ending::lost_target:
    case Ending::cut_batch:
      outcome.codes = {failed ? 1 : 4};
      return outcome;
    case Ending::lua_error:
    case Ending::no_start_image:
      outcome.codes = {failed ? 1 : 2};
      return outcome;
    case Ending::returns:
    case Ending::watchdog_allowed:
      break;
  }
  if (failed) {
    outcome.codes = {1};
  } else if (s.authors_fault || outcome.told.empty()) {
    outcome.codes = {2};
  } else if (unshown) {
    outcome.codes = {3};
  } else {
    outcome.codes = {0};
  }
  return outcome;
}

}  // namespace whirl::oracle
