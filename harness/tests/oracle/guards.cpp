// Clauses on what must always hold, over a window that may be cut short or stay empty, and on faults.
#include <algorithm>
#include <cmath>

#include "harness/tests/oracle/scenario.hpp"

namespace whirl::oracle {
namespace {

struct Span {
  int from = 0;
  std::optional<int> written;  // its end; nothing: that of the run
  std::optional<int> stopped;  // by the plan, if it came so far

  std::optional<int> to(const End& end) const {
    const bool came = stopped && *stopped <= end.last_act_ms;
    if (!came) return written;
    return std::min(*stopped, written.value_or(*stopped));
  }
};

// A guard's window as it was written: for ever, for a time, or until :stop().
Span write_window(Scenario& s, Dice& dice, std::string& duration_argument) {
  Span span{s.now_ms, {}, {}};
  if (dice.chance(0.5)) {
    const int ms = dice.between(2, dice.chance(0.2) ? 2000 : 150);
    span.written = s.now_ms + ms;
    duration_argument = ", '" + std::to_string(ms) + " ms'";
  }
  return span;
}

// Lets the guard stand for a while, and may take it away.
void let_stand(Scenario& s, Dice& dice, const std::string& id, Span& span) {
  if (!dice.chance(0.3)) return;
  s.wait(dice.between(2, 60));
  s.say(id + ":stop()");
  span.stopped = s.now_ms;
}

bool whole(const Span& span, const End& end) {
  const std::optional<int> to = span.to(end);
  return to ? *to <= end.t_ms : end.returned;
}

}  // namespace

void add_signal_guard(Scenario& s, Dice& dice, const std::string& id) {
  const Quality& quality = any_quality(dice);
  const int from = s.now_ms;
  const double level = dice.between(-64, 64) / 16.0;
  const double worst = level + dice.between(1, 64) / 16.0;
  const int peak = from + dice.between(0, 200);
  const bool gone = dice.chance(0.08);
  const auto at = [=](int ms) { return ms == peak ? (gone ? kNaN : worst) : level; };
  s.signals.push_back({"signal_" + id, quality.dimension, at});
  std::string duration_argument;
  Span span = write_window(s, dice, duration_argument);
  const double between = dice.chance(0.5) ? (level + worst) / 2 : worst + 1.0;
  const Unit& unit = quality.units.front();
  s.say("local " + id + " = t:always('signal_" + id + "'" + duration_argument + ")");
  s.say(id + ":at_most('" + std::to_string(between) + " " + unit.symbol + "')");
  const bool due = from <= s.now_ms;
  let_stand(s, dice, id, span);
  s.wait(dice.between(1, 20));
  s.judgements.push_back([=](const End& end, std::vector<Told>& told) {
    if (!due || from > end.last_act_ms) return;
    const int to = std::min(span.to(end).value_or(end.t_ms), end.t_ms);
    const double x = peak >= from && peak <= to ? (gone ? kNaN : worst) : level;
    Told mine{"signal_" + id + ", always", x <= between ? Right::pass : Right::fail, x, between - x,
              1e-9};
    const bool broken = mine.right == Right::fail && !std::isnan(x);
    if (!whole(span, end) && !broken) mine.right = end.returned ? Right::unshown : Right::any;
    told.push_back(mine);
  });
}

// Evaluated at every step of the script, from that of the call.
void add_condition_guard(Scenario& s, Dice& dice, const std::string& id) {
  const int from = s.now_ms;
  const int bad_from = from + dice.between(-5, 120),
            bad_for = dice.between(0, 1) * dice.between(1, 30);
  s.signals.push_back({"signal_" + id, Dimension::length, [=](int ms) {
                         return ms >= bad_from && ms < bad_from + bad_for ? 2.0 : 1.0;
                       }});
  std::string duration_argument;
  Span span = write_window(s, dice, duration_argument);
  s.say("local " + id + " = t:always('" + id + " holds', function(s) return s.signal_" + id +
        "_m < 1.5 end" + duration_argument + ")");
  let_stand(s, dice, id, span);
  if (!dice.chance(0.05)) s.wait(dice.between(1, 20));
  s.judgements.push_back([=](const End& end, std::vector<Told>& told) {
    if (from > end.last_act_ms) return;
    const int last = std::min(span.to(end).value_or(end.last_act_ms), end.last_act_ms);
    const int bad = std::max(0, std::min(last + 1, bad_from + bad_for) - std::max(from, bad_from));
    Told mine{id + " holds (time violated)", bad == 0 ? Right::pass : Right::fail, bad * 1e-3,
              -bad * 1e-3, 1e-9};
    const bool shown = last > from && whole(span, end);
    if (bad == 0 && !shown) mine.right = end.returned ? Right::unshown : Right::any;
    told.push_back(mine);
  });
}

// Of the world or of a wire; applied, or due when nothing passes there.
void add_fault(Scenario& s, Dice& dice, const std::string& id) {
  const bool worlds = dice.chance(0.5), applied = dice.chance(0.7);
  if (worlds) {
    s.world_faults[id + "_lost"] = applied;
    s.say("t:fault { kind = '" + id + "_lost', duration = '20 ms' }");
  } else {
    s.say("t:fault { kind = 'i2c_nack', device = 'esc0', start = '" +
          std::to_string(applied ? 0 : 700) + " s' }");
  }
  s.board_faults.emplace_back(id, applied);
  if (!applied) s.authors_fault = true;
  s.wait(dice.between(3, 40));
}

}  // namespace whirl::oracle
