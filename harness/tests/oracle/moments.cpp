// Clauses that judge at one moment: numbers, values, waits, answers; and what their author forgot.
#include <algorithm>
#include <cmath>

#include "harness/tests/oracle/scenario.hpp"

namespace whirl::oracle {
namespace {

void tell_at(Scenario& s, int ms, const Told& told) {
  s.judgements.push_back([=](const End& end, std::vector<Told>& all) {
    if (ms <= end.last_act_ms) all.push_back(told);
  });
}

Told held(const std::string& name, double took_s, double limit_s) {
  Told told{name, took_s <= limit_s ? Right::pass : Right::fail, took_s, limit_s - took_s, 1e-9};
  told.measured *= 1e3;  // the limits are written in ms
  told.margin *= 1e3;
  return told;
}

}  // namespace

// Bare numbers, some under one name, with two limits in a row.
void add_numbers(Scenario& s, Dice& dice, const std::string& id) {
  const int n = dice.between(1, 4);
  for (int i = 0; i < n; ++i) {
    const double x = dice.chance(0.03) ? kNaN : dice.between(-160, 160) / 16.0;
    const Limited first = limit_near(dice, bare(), x, 0, true),
                  second = limit_near(dice, bare(), x, 0, true);
    const bool both = dice.chance(0.3);
    const std::string number = std::isnan(x) ? "0/0" : std::to_string(x);
    const std::string name = id + " number " + std::to_string(i);
    const std::string twin = dice.chance(0.3) ? name : "";
    s.say("t:expect(" + number + ", '" + name + "')" + first.lua + (both ? second.lua : ""));
    tell_at(s, s.now_ms, first.judge(name, x, 0));
    if (both) tell_at(s, s.now_ms, second.judge(name + " (2)", x, 0));
    if (twin.empty()) continue;
    s.say("t:expect(" + number + ", '" + name + "')" + second.lua);
    tell_at(s, s.now_ms, second.judge(name + (both ? " (3)" : " (2)"), x, 0));
  }
  if (dice.chance(0.4)) {
    s.say("t:expect(t:now(), '" + id + " clock'):within(\"" + std::to_string(s.now_ms) +
          " ms\", \"" + std::to_string(s.now_ms + 1) + " ms\")");
    tell_at(s, s.now_ms, {id + " clock", Right::pass, s.now_ms * 1.0, 0.0, 1e-6});
  }
}

void add_values(Scenario& s, Dice& dice, const std::string& id) {
  const Quality& quality = any_quality(dice);
  const double a = dice.between(-64, 64) / 16.0, slope = dice.between(-8, 8) / 64.0;
  const bool gone = dice.chance(0.04);
  const int from = s.now_ms;
  s.signals.push_back({"signal_" + id, quality.dimension,
                       [=](int ms) { return gone ? kNaN : a + slope * (ms - from); }});
  for (int i = 0; i < 3; ++i) {
    const double x = gone ? kNaN : a + slope * (s.now_ms - from);
    const bool exact = quality.units.front().offset == 0.0;
    const Limited limit = limit_near(dice, quality, x, 1e-12, exact);
    const std::string name = id + " value " + std::to_string(i);
    s.say("t:expect(t:value 'signal_" + id + "', '" + name + "')" + limit.lua);
    tell_at(s, s.now_ms, limit.judge(name, x, 1e-12));
    s.wait(dice.between(1, 20));
  }
}

// A signal that crosses its level once, some ms after the call, or never.
void add_within(Scenario& s, Dice& dice, const std::string& id) {
  const int limit_ms = dice.between(1, 120);
  const int crosses =
      dice.chance(0.1) ? limit_ms : dice.between(1, limit_ms + (dice.chance(0.2) ? 30 : 0));
  const bool meets = crosses <= limit_ms;
  const int from = s.now_ms;
  s.signals.push_back({"signal_" + id, Dimension::length,
                       [=](int ms) { return ms - from >= crosses ? 1.0 : 0.0; }});
  s.say("t:within('" + std::to_string(limit_ms) + " ms', function(s) return s.signal_" + id +
        "_m > 0.5 end, '" + id + " comes')");
  s.now_ms += meets ? crosses : limit_ms;
  tell_at(s, s.now_ms, held(id + " comes", meets ? crosses * 1e-3 : kNaN, limit_ms * 1e-3));
}

// No verdict, but the script branches on what it gives.
void add_wait_until(Scenario& s, Dice& dice, const std::string& id) {
  const int limit_ms = dice.between(1, 100), crosses = dice.between(1, 130), from = s.now_ms;
  const bool meets = crosses <= limit_ms;
  s.signals.push_back({"signal_" + id, Dimension::force,
                       [=](int ms) { return ms - from >= crosses ? -2.0 : 3.0; }});
  s.say("local " + id + " = t:wait_until(function(s) return s.signal_" + id + "_N < 0 end, '" +
        std::to_string(limit_ms) + " ms')");
  s.now_ms += meets ? crosses : limit_ms;
  s.say("t:expect(" + id + " and 1 or 2, '" + id + " came'):equal(1)");
  tell_at(s, s.now_ms,
          {id + " came", meets ? Right::pass : Right::fail, meets ? 1.0 : 2.0, meets ? 0.0 : -1.0,
           1e-12});
}

void add_ask(Scenario& s, Dice& dice, const std::string& id) {
  const int limit_ms = dice.between(1, 80),
            after = dice.between(1, dice.chance(0.2) ? 100 : limit_ms);
  const bool comes = after <= limit_ms, matches = dice.chance(0.93), patterned = dice.chance(0.7);
  const std::string line = "q" + id;  // no bare number: a name would not keep it
  s.answers[line] = {after, matches ? "good 7" : "bad"};
  s.say("t:ask('" + line + "', " + (patterned ? "'^good %d$'" : "nil") + ", '" +
        std::to_string(limit_ms) + " ms')");
  s.now_ms += comes ? after : limit_ms;
  const bool good = comes && (matches || !patterned);
  const int judged_ms = s.now_ms;
  if (!comes)
    s.wait(after - limit_ms + 1);  // the next question must not take this answer for its own
  tell_at(s, judged_ms,
          held("answer to '" + line + "'", good ? after * 1e-3 : kNaN, limit_ms * 1e-3));
}

// An expectation without a limit.
void add_unlimited(Scenario& s, Dice& dice, const std::string&) {
  if (!dice.chance(0.3)) {
    s.say("t:step 'a step'");
    s.say("t:log 'words'");
    s.wait(dice.between(1, 30));
    return;
  }
  s.say("t:expect(1)");
  s.authors_fault = true;
}

}  // namespace whirl::oracle
