// Clauses on records: steps whose metrics are closed forms, and tables whose statistics follow from
// the definitions.
#include <algorithm>
#include <cmath>

#include "harness/tests/oracle/scenario.hpp"

namespace whirl::oracle {
namespace {

constexpr int kReference = 200, kTail = 200;  // ms that make the means before and after

// Says t:expect of a record's metric at the script's present time.
struct Asked {
  Scenario& s;
  Dice& dice;
  std::string record;

  void expect(const std::string& call, const Quality& quality, double x_SI, double tolerance_SI,
              bool exact = false) {
    const std::string name = record + " " + call;
    const Limited limit = limit_near(dice, quality, x_SI, tolerance_SI, exact);
    s.say("t:expect(" + record + ":" + call + ", \"" + name + "\")" + limit.lua);
    const int ms = s.now_ms;
    s.judgements.push_back([=](const End& end, std::vector<Told>& told) {
      if (ms <= end.last_act_ms) told.push_back(limit.judge(name, x_SI, tolerance_SI));
    });
  }
};

// From a to b; at k ms after the command. A ramp or a first-order lag, with a triangular excursion.
struct Step {
  double a = 0, b = 1;
  int delay = 0, ramp = 1;  // ms
  double tau_ms = 0;        // > 0: a lag instead of the ramp
  double share = 0;         // of the excursion, beyond b
  int peak_at = 0, half_width = 1;

  double change() const { return b - a; }
  int settled_by() const { return tau_ms > 0 ? static_cast<int>(18 * tau_ms) : delay + ramp; }
  double at(int k) const {
    if (k < 0) return a;
    if (tau_ms > 0) return b - change() * std::exp(-k / tau_ms);
    const double done = std::clamp(static_cast<double>(k - delay) / ramp, 0.0, 1.0);
    const double away =
        std::max(0.0, 1.0 - std::abs(static_cast<double>(k - peak_at)) / half_width);
    return a + change() * (done + share * away);
  }
};

Step any_step(Dice& dice) {
  Step step;
  step.a = dice.between(-64, 64) / 16.0;
  step.b = step.a + dice.between(1, 64) / 8.0 * (dice.chance(0.5) ? 1 : -1);
  if (dice.chance(0.25)) {
    step.tau_ms = dice.between(8, 20);
    return step;
  }
  step.delay = dice.between(0, 30);
  step.ramp = dice.between(1, 80);
  step.peak_at = step.delay + step.ramp;
  if (dice.chance(0.5)) {
    step.share = dice.between(1, 40) / 100.0;
    step.half_width = dice.between(2, 30);
    step.peak_at += step.half_width + dice.between(0, 10);
  }
  return step;
}

// The settling times into b +- width, or nothing where a sample lies too near the edge to tell.
std::optional<double> settled_ms(const Step& step, double width) {
  const double size = std::abs(step.change());
  const double in_peak = step.half_width * (1.0 - width / (step.share * size));
  double edge = 0;  // the last time at the edge of the band
  if (step.tau_ms > 0) {
    edge = width < size ? step.tau_ms * std::log(size / width) : -0.5;
  } else if (step.share > 0 && in_peak > 0) {
    edge = step.peak_at + in_peak;
  } else {
    edge = width < size ? step.delay + step.ramp * (1.0 - width / size) : -0.5;
  }
  const bool grazed = step.share > 0 && std::abs(in_peak) < 1e-3;
  if (grazed || std::abs(edge - std::round(edge)) < 1e-3) return std::nullopt;
  return edge < 0 ? 0.0 : std::ceil(edge);
}

// What spoils a record, or leaves it whole.
struct Flaw {
  bool flat = false;
  std::optional<int> nan_at;  // ms after the command
  int cut_ms = 0;             // the record ends too early for the mean after the change
};

// What of the record is known: its reference, all after the command, its last 200 ms.
struct Known {
  bool reference = true, all = true, tail = true, change = true;
};

Known known_of(const Flaw& flaw, int command_ms, int length) {
  Known known;
  const auto hit = [&](int from, int to) {
    return flaw.nan_at && *flaw.nan_at >= from && *flaw.nan_at <= to;
  };
  known.reference = command_ms >= kReference && !hit(-kReference, -1);
  known.all = !hit(0, length);
  known.tail = length + 1 >= kTail && !hit(length + 1 - kTail, length);
  known.change = known.reference && known.all && known.tail && !flaw.flat;
  return known;
}

Flaw any_flaw(Dice& dice, int length) {
  Flaw flaw;
  if (dice.chance(0.04)) flaw.flat = true;
  if (dice.chance(0.06)) flaw.nan_at = dice.between(-kReference, length);
  if (dice.chance(0.05)) flaw.cut_ms = length - dice.between(20, kTail - 2);
  return flaw;
}

void ask_times(Asked& ask, const Step& step, const Known& known, double wire_ms) {
  const bool up = step.change() > 0;
  // Linear interpolation of the lag between samples of 1 ms.
  const double tolerance_s = step.tau_ms > 0 ? 1e-3 / step.tau_ms : 1e-11;
  const double rise_ms = step.tau_ms > 0 ? step.tau_ms * std::log(9.0) : 0.8 * step.ramp;
  const double done_ms =
      step.tau_ms > 0 ? step.tau_ms * std::log(10.0) : step.delay + 0.9 * step.ramp;
  if (ask.dice.chance(up ? 0.6 : 0.05)) {
    ask.expect("rise_time()", duration(), known.change && up ? rise_ms * 1e-3 : kNaN, tolerance_s);
  }
  if (ask.dice.chance(up ? 0.05 : 0.6)) {
    ask.expect("fall_time()", duration(), known.change && !up ? rise_ms * 1e-3 : kNaN, tolerance_s);
  }
  if (ask.dice.chance(0.6)) {
    ask.expect("response_time()", duration(), known.change ? (done_ms - wire_ms) * 1e-3 : kNaN,
               tolerance_s);
  }
  if (ask.dice.chance(0.5)) {
    ask.expect("overshoot()", ratio(), known.change ? step.share : kNaN, 2e-7);
  }
}

void ask_settling(Asked& ask, const Step& step, const Known& known, const Flaw& flaw,
                  const Quality& quality) {
  const double size = std::abs(step.change());
  const double share = ask.dice.between(1, 60) / 100.0;
  const auto settled = settled_ms(step, share * size);
  if (!settled) return;
  if (ask.dice.chance(0.4)) {
    ask.expect("settled('" + std::to_string(std::lround(share * 100)) + " %')", duration(),
               known.change ? *settled * 1e-3 : kNaN, 1e-11);
  }
  if (flaw.flat || flaw.cut_ms > 0 || !ask.dice.chance(0.4)) return;
  const Unit& si = quality.units.front();
  const bool inside = ask.dice.chance(0.93);  // or it ends outside of a band elsewhere
  const std::string band = std::to_string(share * size) + " " + si.symbol;
  const std::string target = std::to_string(step.b + (inside ? 0 : 3 * size)) + " " + si.symbol;
  ask.expect("settled('" + band + "', '" + target + "')", duration(),
             known.all && inside ? *settled * 1e-3 : kNaN, 1e-11);
}

void ask_levels(Asked& ask, const Step& step, const Known& known, const Flaw& flaw,
                const Quality& quality) {
  if (flaw.cut_ms > 0) return;
  const double tolerance = 1e-6 * std::abs(step.change());
  const double to = flaw.flat ? step.a : step.b;
  const double beyond = flaw.flat ? step.a : step.b + step.share * step.change();
  if (ask.dice.chance(0.5)) ask.expect("final()", quality, known.tail ? to : kNaN, tolerance);
  if (ask.dice.chance(0.3)) {
    ask.expect("max()", quality, known.all ? std::max(step.a, beyond) : kNaN, tolerance);
  }
  if (ask.dice.chance(0.3)) {
    ask.expect("min()", quality, known.all ? std::min(step.a, beyond) : kNaN, tolerance);
  }
}

}  // namespace

void add_step_record(Scenario& s, Dice& dice, const std::string& id) {
  const Quality& quality = any_quality(dice);
  if (dice.chance(0.95) && s.now_ms < kReference) s.wait(kReference - s.now_ms);
  const Step step = any_step(dice);
  int length =
      std::max(step.settled_by(), step.peak_at + step.half_width) + kTail + dice.between(0, 60);
  const Flaw flaw = any_flaw(dice, length);
  length -= flaw.cut_ms;
  const int command_ms = s.now_ms;
  const std::string signal = "signal_" + id;
  s.signals.push_back({signal, quality.dimension, [=](int ms) {
                         if (flaw.nan_at && ms == command_ms + *flaw.nan_at) return kNaN;
                         return flaw.flat ? step.a : step.at(ms - command_ms);
                       }});
  std::string action;
  double wire_ms = 0;
  if (dice.chance(0.6)) {
    action = ", function() t:command { arm = true } end";
    wire_ms = dice.between(0, 2000) / 1000.0;
    s.wires_ns[command_ms] = command_ms * kMs + std::llround(wire_ms * 1e6);
  }
  s.say("local " + id + " = t:record('" + signal + "', '" + std::to_string(length) + " ms'" +
        action + ")");
  s.now_ms += length;
  Asked ask{s, dice, id};
  const Known known = known_of(flaw, command_ms, length);
  ask_times(ask, step, known, wire_ms);
  ask_settling(ask, step, known, flaw, quality);
  ask_levels(ask, step, known, flaw, quality);
}

namespace {

// A table of random eighths: sums of them and of their squares are exact.
std::vector<double> eighths(Dice& dice, int n) {
  std::vector<double> all;
  all.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) all.push_back(dice.between(-80, 80) / 8.0);
  return all;
}

std::function<double(int)> table(const std::vector<double>& values, int from_ms) {
  return [=](int ms) {
    const int i = ms - from_ms;
    return i >= 0 && i < static_cast<int>(values.size()) ? values[static_cast<std::size_t>(i)]
                                                         : 99.0;
  };
}

double share_below(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  const double at = p * static_cast<double>(values.size() - 1);
  const double below = std::floor(at);
  const double low = values[static_cast<std::size_t>(below)];
  const double high = values[static_cast<std::size_t>(std::ceil(at))];
  return low * (1.0 - (at - below)) + high * (at - below);
}

double mean_square(const std::vector<double>& values, double about) {
  double sum = 0;
  for (double x : values) sum += (x - about) * (x - about);
  return sum / static_cast<double>(values.size());
}

}  // namespace

void add_statistics(Scenario& s, Dice& dice, const std::string& id) {
  const Quality& quality = any_quality(dice);
  const int length = dice.between(1, 150);
  std::vector<double> values = eighths(dice, length + 1);  // both ends are in
  if (dice.chance(0.05)) values[static_cast<std::size_t>(dice.between(0, length))] = kNaN;
  s.signals.push_back({"signal_" + id, quality.dimension, table(values, s.now_ms)});
  s.say("local " + id + " = t:record('signal_" + id + "', '" + std::to_string(length) + " ms')");
  s.now_ms += length;
  const bool spoilt = std::isnan(mean_square(values, 0));
  const auto unless_spoilt = [&](double x) { return spoilt ? kNaN : x; };
  double sum = 0;
  for (double x : values) sum += x;
  const double about = dice.between(-80, 80) / 8.0;
  double worst = 0;
  for (double x : values) worst = std::max(worst, std::abs(x - about));
  const std::string to = "'" + std::to_string(about) + " " + quality.units.front().symbol + "'";
  Asked ask{s, dice, id};
  const double tiny = 1e-12;
  struct Metric {
    std::string call;
    double value;
    bool exact;
  };
  const auto low = [&] { return *std::min_element(values.begin(), values.end()); };
  const auto high = [&] { return *std::max_element(values.begin(), values.end()); };
  for (const Metric& m :
       std::vector<Metric>{{"mean()", sum / static_cast<double>(values.size()), false},
                           {"max()", spoilt ? kNaN : high(), true},
                           {"min()", spoilt ? kNaN : low(), true},
                           {"rms()", std::sqrt(mean_square(values, 0)), false},
                           {"rms_error(" + to + ")", std::sqrt(mean_square(values, about)), false},
                           {"max_error(" + to + ")", worst, true},
                           {"p50()", spoilt ? kNaN : share_below(values, 0.5), false},
                           {"p99()", spoilt ? kNaN : share_below(values, 0.99), false}}) {
    const bool offset = m.call.starts_with("rms") && quality.dimension == Dimension::temperature;
    if (offset || !dice.chance(0.4)) continue;
    const bool exact = m.exact && quality.units.front().offset == 0.0;
    ask.expect(m.call, quality, unless_spoilt(m.value), tiny, exact);
  }
}

// The distance of two signals from a point.
void add_distance(Scenario& s, Dice& dice, const std::string& id) {
  static const Quality length{Dimension::length, "_m", {{"m"}, {"cm", 0.01}}};
  const int duration_ms = dice.between(2, 120);
  const auto x = eighths(dice, duration_ms + 1), y = eighths(dice, duration_ms + 1);
  s.signals.push_back({id + "_x", Dimension::length, table(x, s.now_ms)});
  s.signals.push_back({id + "_y", Dimension::length, table(y, s.now_ms)});
  const double x0 = dice.between(-8, 8) / 8.0, y0 = dice.between(-8, 8) / 8.0;
  double worst = 0, sum = 0, band = 0;
  int last_outside = -1;
  const double width = dice.between(60, 110) / 8.0 + 0.01;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double away = std::hypot(x[i] - x0, y[i] - y0);
    worst = std::max(worst, away);
    sum += away * away;
    if (away > width) last_outside = static_cast<int>(i);
    band = away;
  }
  s.say("local " + id + " = t:record({ '" + id + "_x', '" + id + "_y' }, '" +
        std::to_string(duration_ms) + " ms')");
  s.now_ms += duration_ms;
  const std::string to = "{ " + id + "_x = '" + std::to_string(x0) + " m', " + id + "_y = '" +
                         std::to_string(y0) + " m' }";
  Asked ask{s, dice, id};
  ask.expect("max_error(" + to + ")", length, worst, 1e-12);
  ask.expect("rms_error(" + to + ")", length, std::sqrt(sum / static_cast<double>(x.size())),
             1e-12);
  ask.expect("settled('" + std::to_string(width) + " m', " + to + ")", duration(),
             band > width ? kNaN : (last_outside + 1) * 1e-3, 1e-12);
  ask.expect("max('" + id + "_y')", length, *std::max_element(y.begin(), y.end()), 1e-12, true);
}

}  // namespace whirl::oracle
