// Clauses on what the firmware did and when: calls, the core's load, buses, the way from a sensor to
// an actuator. Each writes its own train of messages.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "harness/tests/oracle/scenario.hpp"

namespace whirl::oracle {
namespace {

constexpr std::int64_t kUs = 1000;

// The window of a budget: from now, to its end or that of the run.
struct Window {
  int from = 0;
  std::optional<int> to;

  std::string argument() const {
    return to ? ", during = '" + std::to_string(*to - from) + " ms'" : "";
  }
  std::int64_t begin_ns() const { return from * kMs; }
  std::int64_t end_ns(const End& end) const {
    return std::min(to.value_or(end.known_ms), end.known_ms) * kMs;
  }
  bool whole(const End& end) const { return to ? *to <= end.known_ms : end.returned; }
};

Window write_window(Scenario& s, Dice& dice) {
  Window window{s.now_ms, {}};
  if (dice.chance(0.5)) window.to = s.now_ms + dice.between(20, dice.chance(0.15) ? 3000 : 200);
  return window;
}

// A worst value under its limit: a failure that was seen stays one; a window that the run has cut short, one without
// a value and what never came have shown nothing. cut: of calls that still ran at its end, where beyond the limit.
void report_worst(const Limited& limit, const std::string& name, std::vector<double> values,
                  const Window& window, const End& end, std::vector<Told>& told,
                  const std::vector<double>& cut = {}, bool came = true) {
  const auto right = [&](double x) { return limit.judge(name, x, 2e-12).right; };
  std::copy_if(cut.begin(), cut.end(), std::back_inserter(values),
               [&](double x) { return right(x) == Right::fail; });
  if (!came && !values.empty() && right(values.front()) == Right::pass) values.clear();
  double worst = values.empty() ? kNaN : values.front();
  for (double x : values) worst = std::isnan(x) || std::isnan(worst) ? kNaN : std::max(worst, x);
  Told mine = limit.judge(name, worst, 2e-12);
  const bool broken = mine.right == Right::fail && !std::isnan(worst);
  if (!window.whole(end) && !broken) mine.right = end.returned ? Right::unshown : Right::any;
  told.push_back(mine);
}

// Times that come every period, moved about by up to `spread`; from and to bound the train.
struct Train {
  std::int64_t period_ns = kMs;
  std::vector<std::int64_t> times_ns;
};

Train any_train(Dice& dice, const Window& window, int run_ms) {
  Train train;
  train.period_ns = dice.between(4, 40) * 250 * kUs;
  const std::int64_t spread = dice.pick<int>({0, 5, 60}) * kUs;
  const std::int64_t first = dice.chance(0.95) ? 0 : window.begin_ns() + dice.between(1, 80) * kMs;
  const std::int64_t last =
      dice.chance(0.95) ? run_ms * kMs : window.begin_ns() + dice.between(0, 100) * kMs;
  if (dice.chance(0.03)) return train;  // it never comes
  const std::int64_t phase = dice.between(20, 200) * kUs;
  for (std::int64_t t = first + phase; t < last; t += train.period_ns) {
    train.times_ns.push_back(
        t + static_cast<std::int64_t>(dice.uniform() * static_cast<double>(spread)));
  }
  return train;
}

// How far the periods within [from, to] are off, the gaps at the edges included.
std::vector<double> off_period(const std::vector<std::int64_t>& times, std::int64_t from,
                               std::int64_t to, std::int64_t period) {
  std::vector<double> all;
  std::int64_t before = from;
  bool any = false;
  for (std::int64_t t : times) {
    const std::int64_t off = t - before - period;
    if (any) all.push_back(static_cast<double>(std::abs(off)) * 1e-9);
    if (!any && off > 0) all.push_back(static_cast<double>(off) * 1e-9);
    before = t;
    any = true;
  }
  if (to - before > period) all.push_back(static_cast<double>(to - before - period) * 1e-9);
  return all;
}

double worst_of(const std::vector<double>& values) {
  return values.empty() ? kNaN : *std::max_element(values.begin(), values.end());
}

struct Call {
  std::int64_t entry_ns, return_ns, execution_ns, latency_ns;
};

// Those that began and ended within.
std::vector<Call> within(const std::vector<Call>& calls, std::int64_t from, std::int64_t to) {
  std::vector<Call> inside;
  for (const Call& c : calls) {
    if (c.entry_ns >= from && c.return_ns <= to) inside.push_back(c);
  }
  return inside;
}

std::vector<double> seconds_of(const std::vector<Call>& calls, std::int64_t (*what)(const Call&)) {
  std::vector<double> all;
  all.reserve(calls.size());
  for (const Call& c : calls) all.push_back(what(c) < 0 ? kNaN : double(what(c)) * 1e-9);
  return all;
}

void post_calls(Scenario& s, std::uint16_t number, const std::vector<Call>& calls) {
  for (const Call& c : calls) {
    s.messages.push_back({c.return_ns, [=](io::Batch& batch) {
                            batch.add(io::Kind::function_call, number, c.return_ns,
                                      io::FunctionCall{c.entry_ns, c.execution_ns, c.latency_ns});
                          }});
  }
}

int horizon(const Scenario& s) {
  return s.now_ms + 400;  // beyond what most scenarios run; the train may go on after the end
}

}  // namespace

void add_budget(Scenario& s, Dice& dice, const std::string& id) {
  const Window window = write_window(s, dice);
  const Train train = any_train(dice, window, horizon(s) + 1600);
  const bool interrupt = dice.chance(0.93);
  std::vector<Call> calls;
  for (std::int64_t t : train.times_ns) {
    const std::int64_t runs = dice.between(5, 90) * kUs,
                       held = dice.chance(0.2) ? dice.between(1, 60) * kUs : 0;
    const bool known = interrupt || dice.chance(0.5);
    calls.push_back({t, t + runs + held, runs, known ? dice.between(0, 9000) : -1});
  }
  const auto number = static_cast<std::uint16_t>(s.functions.size());
  const std::string function = "fw::" + id;
  s.functions.push_back(function);
  post_calls(s, number, calls);
  s.wait(dice.between(5, 150));
  using Values = std::function<std::vector<double>(std::int64_t, std::int64_t, std::int64_t)>;
  struct Part {
    std::string name;
    Limited limit;
    Values values, cut;
  };
  // The limits lie near what comes in a window that is not cut.
  const std::int64_t from = window.begin_ns(), to = window.to ? *window.to * kMs : horizon(s) * kMs;
  std::vector<Part> parts;
  std::string keys;
  const Values none = [](auto...) { return std::vector<double>{}; };
  const auto add = [&](const std::string& key, const std::string& name, auto values, Values cut) {
    const Limited limit = most_near(dice, duration(), worst_of(values(from, to, to + kMs)), 2e-12);
    keys += ", " + key + " = " + limit.lua;
    parts.push_back({function + " " + name, limit, values, std::move(cut)});
  };
  const auto entries = [=](std::int64_t a, std::int64_t b, std::int64_t known) {
    std::vector<std::int64_t> all;
    for (const Call& c : calls) {
      if (c.entry_ns >= a && c.entry_ns <= b && c.return_ns <= known) all.push_back(c.entry_ns);
    }
    return all;
  };
  if (dice.chance(0.6)) {
    keys += ", period = '" + std::to_string(train.period_ns) + " ns'";
    const auto off = [=](std::int64_t a, std::int64_t b, std::int64_t known) {
      return off_period(entries(a, b, known), a, b, train.period_ns);
    };
    add("jitter", "period jitter", off, none);
  }
  const auto cut = [=](bool executed) -> Values {
    return [=](std::int64_t a, std::int64_t b, std::int64_t known) {
      std::vector<double> all;
      for (const Call& c : calls) {
        if (c.entry_ns < a || c.entry_ns > b || c.return_ns <= b || c.return_ns > known) continue;
        all.push_back(static_cast<double>(executed ? c.execution_ns : b - c.entry_ns) * 1e-9);
      }
      return all;
    };
  };
  const auto of = [=](std::int64_t (*what)(const Call&)) {
    return [=](std::int64_t a, std::int64_t b, std::int64_t) {
      return seconds_of(within(calls, a, b), what);
    };
  };
  if (parts.empty() || dice.chance(0.5))
    add("execution", "execution time", of([](const Call& c) { return c.execution_ns; }), cut(true));
  if (dice.chance(0.4))
    add("response", "response time", of([](const Call& c) { return c.return_ns - c.entry_ns; }),
        cut(false));
  if (dice.chance(0.4))
    add("latency", "interrupt latency", of([](const Call& c) { return c.latency_ns; }), none);
  // Said at the window's begin: before the wait above.
  const std::string line =
      "t:budget('" + function + "') { " + keys.substr(2) + window.argument() + " }";
  s.lua.insert(s.lua.rfind("  t:wait"), "  " + line + "\n");
  s.judgements.push_back([=](const End& end, std::vector<Told>& told) {
    if (window.from > end.last_act_ms) return;
    for (const Part& part : parts) {
      const std::int64_t b = window.end_ns(end), known = end.known_ms * kMs;
      const bool came = !entries(from, b, known).empty();
      report_worst(part.limit, part.name, part.values(from, b, known), window, end, told,
                   part.cut(from, b, known), came);
    }
  });
}

// One stream of load for the run: pieces of 10 ms.
void add_busy(Scenario& s, Dice& dice, const std::string& id) {
  if (s.answers.count("busy") != 0) return s.wait(3);
  s.answers["busy"] = {};
  const Window window = write_window(s, dice);
  std::vector<int> load;  // percent of each piece
  const bool none = dice.chance(0.1);
  load.reserve(500);
  for (int i = 0; i < (horizon(s) + 3000) / 10; ++i) load.push_back(dice.between(0, 100));
  for (std::size_t i = 0; i < load.size() && !none; ++i) {
    const std::int64_t since = static_cast<std::int64_t>(i) * 10 * kMs, until = since + 10 * kMs;
    const std::int64_t busy = load[i] * 100 * kUs;
    s.messages.push_back({until, [=](io::Batch& batch) {
                            batch.add(io::Kind::busy_time, 0, until, io::BusyTime{since, busy});
                          }});
  }
  const auto share = [=](std::int64_t from, std::int64_t to) -> std::vector<double> {
    double sum = 0, n = 0;
    for (std::size_t i = 0; i < load.size() && !none; ++i) {
      const std::int64_t since = static_cast<std::int64_t>(i) * 10 * kMs;
      if (since < from || since + 10 * kMs > to) continue;
      sum += load[i] * 0.01;
      n += 1;
    }
    if (n == 0) return {};
    return {sum / n};
  };
  const Limited limit =
      most_near(dice, ratio(), worst_of(share(window.begin_ns(), horizon(s) * kMs)), 1e-12);
  s.say("t:budget 'cpu' { busy = " + limit.lua + window.argument() + " }");
  s.wait(dice.between(5, 80));
  (void)id;
  s.judgements.push_back([=](const End& end, std::vector<Told>& told) {
    if (window.from > end.last_act_ms) return;
    report_worst(limit, "CPU busy share", share(window.begin_ns(), window.end_ns(end)), window, end,
                 told);
    // A mean over a part of its time says nothing of the whole.
    if (!window.whole(end)) told.back().right = end.returned ? Right::unshown : Right::any;
  });
}

void add_bus(Scenario& s, Dice& dice, const std::string& id) {
  const bool spi = dice.chance(0.3);
  const Window window = write_window(s, dice);
  const Train train = any_train(dice, window, horizon(s) + 1600);
  auto& devices = spi ? s.spi_devices : s.i2c_devices;
  devices.push_back("dev_" + id);
  const auto place = static_cast<std::uint16_t>(devices.size() - 1);
  struct Transfer {
    std::int64_t start_ns;
    bool read, acked, lone;  // lone: of a length of its own
  };
  std::vector<Transfer> all;
  const bool reads_too = !spi && dice.chance(0.4), odd_ones = dice.chance(0.3),
             bad_ones = dice.chance(0.3);
  for (std::int64_t t : train.times_ns) {
    all.push_back({t, false, !(bad_ones && dice.chance(0.05)), false});
    if (reads_too) all.push_back({t + 90 * kUs, true, true, false});
    if (odd_ones && dice.chance(0.3)) all.push_back({t + 180 * kUs, false, true, true});
  }
  for (const Transfer& x : all) {
    s.messages.push_back({x.start_ns + 50 * kUs, [=](io::Batch& batch) {
                            const std::uint8_t bytes[4] = {1, 2, 3, 4};
                            const io::BusTransaction head{
                                x.start_ns, static_cast<std::uint16_t>(spi ? place : 0x29 + place),
                                static_cast<std::uint8_t>(x.read),
                                static_cast<std::uint8_t>(x.acked), x.lone ? 4u : 3u};
                            batch.add(spi ? io::Kind::spi_transaction : io::Kind::i2c_transaction,
                                      spi ? 1 : 3, x.start_ns + 50 * kUs, head, bytes, head.length);
                          }});
  }
  std::string name = "dev_" + id, keys = "device = 'dev_" + id + "'";
  const bool directed = !spi && (reads_too || dice.chance(0.5)),
             sized = odd_ones || dice.chance(0.3);
  if (directed) keys += ", direction = 'write'";
  if (directed) name += " write";
  if (sized) keys += ", bytes = 3";
  const auto chosen = [=](std::int64_t from, std::int64_t to, std::int64_t known) {
    std::vector<Transfer> mine;
    for (const Transfer& x : all) {
      if ((directed && x.read) || (sized && x.lone) || x.start_ns + 50 * kUs > known) continue;
      if (x.start_ns >= from && x.start_ns <= to) mine.push_back(x);
    }
    return mine;
  };
  const auto periods = [=](std::int64_t from, std::int64_t to, std::int64_t known) {
    std::vector<std::int64_t> starts;
    for (const Transfer& x : chosen(from, to, known)) starts.push_back(x.start_ns);
    return off_period(starts, from, to, train.period_ns);
  };
  std::optional<Limited> tolerance;
  if (spi || dice.chance(0.8)) {  // SPI has no acknowledge that could be judged instead
    const std::int64_t to = window.to ? *window.to * kMs : horizon(s) * kMs;
    tolerance =
        most_near(dice, duration(), worst_of(periods(window.begin_ns(), to, to + kMs)), 2e-12);
    keys +=
        ", period = '" + std::to_string(train.period_ns) + " ns', tolerance = " + tolerance->lua;
  }
  const int allowed = !spi && dice.chance(0.4) ? dice.between(0, 3) : 0;
  if (allowed > 0) keys += ", nacks = " + std::to_string(allowed);
  s.say("t:bus { " + keys + window.argument() + " }");
  s.wait(dice.between(5, 150));
  s.judgements.push_back([=](const End& end, std::vector<Told>& told) {
    if (window.from > end.last_act_ms) return;
    const std::int64_t from = window.begin_ns(), to = window.end_ns(end),
                       known = end.known_ms * kMs;
    if (tolerance)
      report_worst(*tolerance, name + " period deviation", periods(from, to, known), window, end,
                   told, {}, !chosen(from, to, known).empty());
    if (spi) return;
    const auto mine = chosen(from, to, known);
    const auto refused =
        std::count_if(mine.begin(), mine.end(), [](const Transfer& x) { return !x.acked; });
    const double n = static_cast<double>(refused);
    Told nacks{name + " NACKs", n <= allowed ? Right::pass : Right::fail, n, allowed - n, 1e-9};
    if (mine.empty()) nacks = {nacks.name, Right::fail, kNaN, kNaN, 0};
    const bool broken = nacks.right == Right::fail && !mine.empty();
    if (!window.whole(end) && !broken) nacks.right = end.returned ? Right::unshown : Right::any;
    told.push_back(nacks);
  });
}

// Every n ms a sample goes through two tasks into a write; which sample it was is known by making.
void add_latency(Scenario& s, Dice& dice, const std::string& id) {
  if (s.answers.count("latency") != 0) return s.wait(3);
  s.answers["latency"] = {};
  const Window window = write_window(s, dice);
  s.i2c_devices.push_back("dev_" + id);
  const auto address = static_cast<std::uint16_t>(0x29 + s.i2c_devices.size() - 1);
  const auto first = static_cast<std::uint16_t>(s.functions.size()),
             second = static_cast<std::uint16_t>(first + 1);
  s.functions.push_back("fw::" + id + "_reads");
  s.functions.push_back("fw::" + id + "_steers");
  const int n = dice.between(2, 8), run_ms = horizon(s) + 1600;
  const bool early = dice.chance(0.15);  // a write before any sample
  struct Write {
    std::int64_t start_ns, stop_ns;
    double latency_s;
  };
  std::vector<Write> writes;
  std::vector<Call> reads, steers;
  std::vector<std::int64_t> samples;
  const int begin = early ? window.from + 3 : 0;
  for (int ms = begin; ms < run_ms; ++ms) {
    const std::int64_t ready = ms * kMs + 100 * kUs;
    samples.push_back(ready);
    reads.push_back({ready + 30 * kUs, ready + 130 * kUs, 100 * kUs, 0});
    if (ms % n != 0) continue;
    const std::int64_t entry = ready + 140 * kUs;
    steers.push_back({entry, entry + 50 * kUs, 50 * kUs, -1});
    const std::int64_t start = entry + dice.between(10, n * 1000 - 300) * kUs;
    writes.push_back(
        {start, start + 80 * kUs, static_cast<double>(start + 80 * kUs - ready) * 1e-9});
  }
  if (early) writes.push_back({window.from * kMs + kMs, window.from * kMs + 2 * kMs, kNaN});
  for (std::int64_t t : samples) {
    s.messages.push_back(
        {t, [t](io::Batch& batch) { batch.add(io::Kind::data_ready, 0, t, nullptr, 0); }});
  }
  post_calls(s, first, reads);
  post_calls(s, second, steers);
  for (const Write& w : writes) {
    s.messages.push_back({w.stop_ns, [=](io::Batch& batch) {
                            const io::BusTransaction head{w.start_ns, address, 0, 1, 0};
                            batch.add(io::Kind::i2c_transaction, 3, w.stop_ns, head);
                          }});
  }
  const auto latencies = [=](std::int64_t from, std::int64_t to) {
    std::vector<double> all;
    for (const Write& w : writes) {
      if (w.start_ns >= from && w.stop_ns <= to) all.push_back(w.latency_s);
    }
    return all;
  };
  const std::int64_t to = window.to ? *window.to * kMs : horizon(s) * kMs;
  const Limited limit =
      most_near(dice, duration(), worst_of(latencies(window.begin_ns(), to)), 2e-12);
  s.say("t:latency { from = 'imu', through = { 'fw::" + id + "_reads', 'fw::" + id +
        "_steers' }, to = 'dev_" + id + "', at_most = " + limit.lua + window.argument() + " }");
  s.wait(dice.between(10, 150));
  s.judgements.push_back([=](const End& end, std::vector<Told>& told) {
    if (window.from > end.last_act_ms) return;
    report_worst(limit, "imu to dev_" + id + " latency",
                 latencies(window.begin_ns(), window.end_ns(end)), window, end, told);
  });
}

}  // namespace whirl::oracle
