// t:budget, t:bus, t:latency: windows on what the firmware did and when, judged at the end.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "harness/metrics/timing.hpp"
#include "harness/plan/budget_shares.hpp"
#include "harness/plan/budget_stack.hpp"
#include "harness/plan/raise.hpp"
#include "harness/plan/timing_window.hpp"
#include "harness/plan/values.hpp"
#include "harness/plan/watched_calls.hpp"
#include "io_bridges/board_description/bus_name.hpp"

namespace whirl::plan {
namespace {

struct Budget {
  std::string function, place;
  std::optional<Limit> period, jitter, execution, response, latency, busy;
  double margin = 0.0;  // of each limit, to be left
  std::size_t node = 0;
  int number = -1;  // of the function on its board
  BudgetShares shares;
};

Limit less_margin(const Limit& limit, double margin) {
  return {limit.value_SI * (1.0 - margin), limit.unit};
}

std::string margin_note(const Budget& b, const Limit& limit) {
  if (b.margin == 0.0) return "";
  char text[64];
  std::snprintf(text, sizeof text, "%.6g %s less %.3g %%", in_unit(limit.value_SI, limit.unit),
                limit.unit.c_str(), b.margin * 100.0);
  return text;
}

// What code takes is as accurate as the clock that its cycles are counted on.
void judge_code_time(Script& self, std::span<const double> values, const Budget& b,
                     const Limit& limit, const std::string& what, std::int64_t to_ns) {
  const auto d = metrics::distribution(values);
  const std::string less = margin_note(b, limit);
  self.judge_in_window({d.max, Dimension::time, b.function + " " + what}, Script::Figure::extreme,
                       less_margin(limit, b.margin), b.place, seconds(to_ns),
                       spread(d, limit.unit) + (less.empty() ? "" : "; " + less),
                       self.stage().nodes[b.node].board.timing_accuracy());
}

// Of one trace: all of it is on one board, so that its node's name need be given once only.
std::string on_node(lua_State* L, Script& self, std::size_t node, const std::string& text) {
  if (text.find('/') == std::string::npos) return text;
  const NodePlace at = node_at(L, self, text);
  if (at.node != node) raise(L, "'" + text + "' is on another board", "a latency is of one board");
  return at.rest;
}

// What a call that still ran at the window's end tells: that it took more than it may, or that nobody knows.
void add_cut_calls(Script& self, const Budget& b, WatchedCalls& calls) {
  const auto beyond = [&b](double x_s, const std::optional<Limit>& limit) {
    return limit && x_s > less_margin(*limit, b.margin).value_SI;
  };
  for (const WatchedCalls::Cut& cut : calls.cut) {
    if (beyond(cut.lasted_s, b.response)) calls.response_s.push_back(cut.lasted_s);
    if (beyond(cut.execution_s, b.execution)) calls.execution_s.push_back(cut.execution_s);
    if (std::isnan(cut.execution_s) && beyond(cut.lasted_s, b.execution))
      self.not_seen_whole("a call never returned");
  }
}

void judge_calls(Script& self, const Budget& b, std::int64_t from, std::int64_t to) {
  WatchedCalls calls =
      calls_between(self.stage().logs[b.node], static_cast<std::uint16_t>(b.number), from, to);
  add_cut_calls(self, b, calls);
  if (b.jitter) {
    const double most_s = less_margin(*b.jitter, b.margin).value_SI;
    judge_code_time(self, deviations(calls.entries_ns, from, to, b.period->value_SI, most_s), b,
                    *b.jitter, "period jitter", to);
  }
  if (b.execution) judge_code_time(self, calls.execution_s, b, *b.execution, "execution time", to);
  if (b.response) judge_code_time(self, calls.response_s, b, *b.response, "response time", to);
  if (b.latency) judge_code_time(self, calls.latency_s, b, *b.latency, "interrupt latency", to);
}

void judge_busy(Script& self, const Budget& b, std::int64_t from, std::int64_t to) {
  self.judge_in_window({self.stage().logs[b.node].busy_share(from, to), Dimension::ratio,
                        self.stage().nodes[b.node].qualified("CPU busy share")},
                       Script::Figure::of_all, less_margin(*b.busy, b.margin), b.place, seconds(to),
                       margin_note(b, *b.busy), self.stage().nodes[b.node].board.timing_accuracy());
}

// The { ... } of t:budget("name") { ... }
int read_budget(lua_State* L) {
  Script& self = Script::of(L);
  must_offer(L, self, "budget");
  const lua::Table given = check_table(L, 1);
  Budget b;
  b.function = lua_tostring(L, lua_upvalueindex(1));
  b.place = place_of(L);
  b.period = optional_period(given);
  b.jitter = optional_limit(given, "jitter", Dimension::time);
  b.execution = optional_limit(given, "execution", Dimension::time);
  b.response = optional_limit(given, "response", Dimension::time);
  b.latency = optional_limit(given, "latency", Dimension::time);
  b.busy = optional_limit(given, "busy", Dimension::ratio, kShare);
  b.margin = given.quantity_or("margin", Dimension::ratio, 0.0, lua::between(0.0, 0.9));
  const NodePlace at = node_at(L, self, b.function);
  b.shares = read_budget_shares(given, self.stage().nodes[at.node].board);
  const StackBudget stack = read_stack_budget(given, at.node, b.function, b.place);
  const std::int64_t end = window_end(self, given);
  check_finish(L, given);
  const bool calls = b.shares.asked() || b.jitter || b.execution || b.response || b.latency;
  if (b.period.has_value() != b.jitter.has_value()) raise(L, "period and jitter go together");
  if (!calls && !b.busy && !stack.depth)
    raise(L, "a budget of nothing",
          "give jitter, execution, response, latency, share, rate, busy or depth");
  b.node = at.node;
  b.number = self.stage().nodes[at.node].board.watch_number(at.rest);
  if (b.busy && at.rest != "cpu") {
    raise(L, "busy is of the core, not of '" + at.rest + "'", "t:budget(\"cpu\") { busy = ... }");
  }
  if (stack.depth && at.rest != "stack") {
    raise(L, "depth is of the stack, not of '" + at.rest + "'",
          "t:budget(\"stack\") { depth = ... }");
  }
  if (calls && b.number < 0) {
    raise(L, "'" + b.function + "' is not watched",
          "add it to the watch list of the plan or board");
  }
  self.add_window(end, [b, calls, stack](Script& script, std::int64_t from, std::int64_t to) {
    if (calls) judge_calls(script, b, from, to);
    if (b.busy) judge_busy(script, b, from, to);
    if (stack.depth) judge_stack(script, stack, to);
    const BudgetWindow window{b.function, b.place, b.node, b.number, from, to};
    if (b.shares.asked()) judge_budget_shares(script, b.shares, window);
  });
  return 0;
}

int budget(lua_State* L) {
  check_text(L, 2, "a function's name, \"cpu\" or \"stack\"");
  lua_pushvalue(L, 2);
  lua_pushcclosure(L, read_budget, 1);
  return 1;
}

struct BusWindow {
  std::string name, place;
  bool spi = false, any_direction = true, read = false;
  int bus = 0, address = 0;
  std::size_t node = 0;
  std::int64_t bytes = 0;  // 0: transactions of any length
  std::optional<Limit> period, tolerance;
  std::int64_t nacks = 0;
};

void judge_bus(Script& self, const BusWindow& w, std::int64_t from, std::int64_t to) {
  std::vector<std::int64_t> starts;
  std::int64_t refused = 0;
  for (const auto& r : self.stage().logs[w.node].bus) {
    if (r.spi != w.spi || r.bus != w.bus || r.address != w.address) continue;
    if (!w.any_direction && r.read != w.read) continue;
    if (w.bytes > 0 && r.length != w.bytes) continue;
    if (r.start_ns < from || r.start_ns > to) continue;
    starts.push_back(r.start_ns);
    refused += r.acked ? 0 : 1;
  }
  auto figure = Script::Figure::extreme;
  if (unread_between(self.stage().logs[w.node], w.spi, w.bus, from, to)) {
    self.not_seen_whole(kUnread);
    figure = Script::Figure::of_all;
  }
  if (w.period) {
    judge_spread(self, deviations(starts, from, to, w.period->value_SI, w.tolerance->value_SI),
                 *w.tolerance, w.name + " period deviation", w.place, to, figure);
  }
  if (w.spi) return;  // SPI has no acknowledge
  const double count = starts.empty() ? std::nan("") : static_cast<double>(refused);
  self.judge_in_window({count, Dimension::none, w.name + " NACKs"}, figure,
                       Limit{static_cast<double>(w.nacks), ""}, w.place, seconds(to),
                       std::to_string(starts.size()) + " transactions");
}

int numbered_bus(lua_State* L, const BoardDevice& device) {
  const auto number = bus_number(device.bus);
  if (!number) raise(L, device.name + " is on '" + device.bus + "', which is no bus");
  return *number;
}

// t:bus { pin = "throttle", period = "20 ms", tolerance = "50 us", high = "1.5 ms" }: from rise to rise, and how long
// it is high.
int pin_window(lua_State* L, Script& self, const lua::Table& given) {
  const std::string name = given.text("pin");
  const NodePlace at = node_at(L, self, name);
  const BoardDescription& board = self.stage().nodes[at.node].board;
  const auto pin = std::find_if(board.pins.begin(), board.pins.end(),
                                [&](const BoardPin& p) { return p.name == at.rest; });
  if (pin == board.pins.end())
    raise(L, "'" + at.rest + "' is no pin that " + board.name + " names");
  must_see(L, self, "pin_" + at.rest);
  const auto number = static_cast<std::uint16_t>(pin - board.pins.begin());
  const auto period = optional_period(given);
  const auto tolerance = optional_limit(given, "tolerance", Dimension::time);
  const auto high = optional_limit(given, "high", Dimension::time);
  const std::int64_t end = window_end(self, given);
  check_finish(L, given);
  if (!period || !tolerance) raise(L, "a pin is judged by its period and tolerance");
  const std::string place = place_of(L);
  self.add_window(end, [=](Script& script, std::int64_t from, std::int64_t to) {
    const auto& pulses = script.stage().logs[at.node].pulses;
    std::vector<std::int64_t> rises;
    std::vector<double> off;
    if (const auto found = pulses.find(number); found != pulses.end()) {
      for (const results::PulseRecord& pulse : found->second) {
        if (pulse.rise_ns < from || pulse.rise_ns > to) continue;
        rises.push_back(pulse.rise_ns);
        if (!high || pulse.fall_ns < 0 || pulse.fall_ns > to) continue;
        off.push_back(std::abs(seconds(pulse.fall_ns - pulse.rise_ns) - high->value_SI));
      }
    }
    judge_spread(script, deviations(rises, from, to, period->value_SI, tolerance->value_SI),
                 *tolerance, name + " period deviation", place, to);
    if (high) judge_spread(script, off, *tolerance, name + " width deviation", place, to);
  });
  return 0;
}

// t:bus { device = "esc1", direction = "write", period = "20 ms", tolerance = "0.5 ms" }
// bytes = n judges the transactions of that length only: a driver may check a register in between.
int bus(lua_State* L) {
  Script& self = Script::of(L);
  must_offer(L, self, "bus");
  const lua::Table given = check_table(L, 2);
  if (given.has("pin")) return pin_window(L, self, given);
  const std::string name = given.text("device");
  const NodePlace at = node_at(L, self, name);
  const BoardDescription& board = self.stage().nodes[at.node].board;
  const BoardDevice* device = board.find(at.rest);
  if (device == nullptr) raise(L, "unknown device '" + at.rest + "' on " + board.name);
  BusWindow w;
  w.name = name;
  w.node = at.node;
  w.place = place_of(L);
  w.spi = device->bus.starts_with("spi");
  if (!w.spi && !device->bus.starts_with("i2c"))
    raise(L, name + " is on " + device->bus + ", not I2C or SPI",
          "frames on CAN are judged by t:can");
  w.bus = numbered_bus(L, *device);
  must_see(L, self, device->bus);
  w.address = w.spi ? board.number(at.rest) : device->address;
  if (!w.spi && w.address < 0) raise(L, name + " has no address on its bus: nobody calls it");
  for (const char* key : {"direction", "nacks"}) {
    if (w.spi && given.has(key))
      given.refuse(key, "SPI goes both ways at once and acknowledges nothing");
  }
  if (given.has("direction")) {
    w.any_direction = false;
    w.read = given.choice("direction", {"read", "write"}) == "read";
    w.name += w.read ? " read" : " write";
  }
  w.period = optional_period(given);
  w.tolerance = optional_limit(given, "tolerance", Dimension::time);
  w.nacks = given.integer_or("nacks", 0, 0);
  w.bytes = given.integer_or("bytes", 0, 0);
  const std::int64_t end = window_end(self, given);
  check_finish(L, given);
  if (w.period.has_value() != w.tolerance.has_value()) raise(L, "period and tolerance go together");
  if (w.spi && !w.period) {
    raise(L, "a window of nothing: SPI has no acknowledge", "give period and tolerance");
  }
  self.add_window(end, [w](Script& script, std::int64_t from, std::int64_t to) {
    judge_bus(script, w, from, to);
  });
  return 0;
}

struct Actuator {
  bool can = false;  // reached by the microcontroller's esc.RawCommand
  int bus = 0, address = 0;
  bool operator==(const Actuator&) const = default;
};

struct LatencyWindow {
  std::string name, place;
  std::size_t node = 0;
  std::uint16_t sensor = 0;
  std::vector<std::uint16_t> through;
  std::vector<Actuator> actuators;
  Limit limit;
};

constexpr std::uint32_t kRawCommand = 1030;  // esc.RawCommand of DroneCAN: one frame for all

std::vector<metrics::Span> writes_to(const results::EventLog& log, const Actuator& actuator,
                                     std::int64_t from, std::int64_t to) {
  std::vector<metrics::Span> writes;
  for (const auto& r : log.can) {
    const bool command = actuator.can && r.good && r.sender < 0 && r.is_message(kRawCommand);
    if (!command || r.bus != actuator.bus || r.start_ns < from || r.end_ns > to) continue;
    writes.push_back({r.start_ns, r.end_ns});
  }
  if (actuator.can) return writes;
  for (const auto& r : log.bus) {
    if (r.spi || r.read || r.bus != actuator.bus || r.address != actuator.address) continue;
    if (r.start_ns >= from && r.stop_ns <= to) writes.push_back({r.start_ns, r.stop_ns});
  }
  return writes;
}

void judge_latency(Script& self, const LatencyWindow& w, std::int64_t from, std::int64_t to) {
  const auto& events = self.stage().logs[w.node];
  std::vector<std::vector<metrics::Span>> tasks;
  for (std::uint16_t number : w.through) {
    auto& spans = tasks.emplace_back();
    const auto calls = events.calls.find(number);
    if (calls == events.calls.end()) continue;
    for (const auto& call : calls->second) spans.push_back({call.entry_ns, call.return_ns});
  }
  const auto ready = events.data_ready_ns.find(w.sensor);
  results::Histogram histogram{w.name, "s", {}, w.limit.value_SI};
  std::size_t untraced = 0, unwritten = 0;
  for (const Actuator& actuator : w.actuators) {
    const auto trace = metrics::trace_latency(
        ready == events.data_ready_ns.end() ? std::span<const std::int64_t>{} : ready->second,
        tasks, writes_to(events, actuator, from, to));
    for (const auto& sample : trace.samples) histogram.samples.push_back(sample.latency_s);
    untraced += trace.untraced;
    unwritten += trace.samples.empty() && trace.untraced == 0 ? 1 : 0;
  }
  const auto d = metrics::distribution(histogram.samples);
  // A write that cannot be traced has no known latency, nor has what nobody wrote to: that is not a pass.
  const double worst = untraced + unwritten > 0 ? std::nan("") : d.max;
  auto figure = Script::Figure::extreme;
  for (const Actuator& actuator : w.actuators) {
    if (!unread_between(events, false, actuator.bus, from, to)) continue;
    self.not_seen_whole(kUnread);
    figure = Script::Figure::of_all;
  }
  std::string note = spread(d, w.limit.unit);
  if (untraced > 0)
    note += "; " + std::to_string(untraced) + " writes cannot be traced to a sample";
  if (unwritten > 0 && d.count > 0)
    note += "; nothing traced to " + std::to_string(unwritten) + " of " +
            std::to_string(w.actuators.size()) + " actuators";
  self.judge_in_window({worst, Dimension::time, w.name}, figure, w.limit, w.place, seconds(to),
                       note);
  self.stage().report.histograms.push_back(std::move(histogram));
}

// t:latency { from = "imu", through = { "fw::imu_task", ... }, to = "esc", at_most = "7 ms" }
int latency(lua_State* L) {
  Script& self = Script::of(L);
  must_offer(L, self, "latency");
  const lua::Table given = check_table(L, 2);
  const NodePlace at = node_at(L, self, given.text("from"));
  const BoardDescription& board = self.stage().nodes[at.node].board;
  const std::string from = at.rest, to = on_node(L, self, at.node, given.text("to"));
  LatencyWindow w;
  w.name = self.stage().nodes[at.node].qualified(from) + " to " + to + " latency";
  w.node = at.node;
  w.place = place_of(L);
  if (board.number(from) < 0) raise(L, "unknown device '" + from + "' on " + board.name);
  w.sensor = static_cast<std::uint16_t>(board.number(from));
  for (const std::string& function : given.texts("through")) {
    const int number = board.watch_number(on_node(L, self, at.node, function));
    if (number < 0) raise(L, "'" + function + "' is not watched", "add it to the watch list");
    w.through.push_back(static_cast<std::uint16_t>(number));
  }
  for (const BoardDevice& device : board.devices) {
    const bool meant = device.name == to || (to == "esc" && device.motor > 0);
    const bool can = device.bus.starts_with("can");
    if (!meant || (!can && !device.bus.starts_with("i2c"))) continue;
    const Actuator actuator{can, numbered_bus(L, device), can ? 0 : device.address};
    if (std::find(w.actuators.begin(), w.actuators.end(), actuator) != w.actuators.end()) continue;
    w.actuators.push_back(actuator);
  }
  if (w.actuators.empty()) raise(L, "no device '" + to + "' on I2C or CAN of " + board.name);
  w.limit.value_SI = given.quantity("at_most", Dimension::time, lua::above(0.0));
  w.limit.unit = unit_symbol(given.text("at_most"));
  const std::int64_t end = window_end(self, given);
  check_finish(L, given);
  self.add_window(end, [w](Script& script, std::int64_t begin_ns, std::int64_t end_ns) {
    judge_latency(script, w, begin_ns, end_ns);
  });
  return 0;
}

}  // namespace

void add_timing_calls(lua_State* L) {
  const luaL_Reg calls[] = {
      {"budget", budget}, {"bus", bus}, {"latency", latency}, {nullptr, nullptr}};
  luaL_setfuncs(L, calls, 0);
}

}  // namespace whirl::plan
