// t:can: windows on the frames of a CAN bus: how often a message comes, errors, load.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "harness/plan/raise.hpp"
#include "harness/plan/timing_window.hpp"
#include "io_bridges/board_description/bus_name.hpp"

namespace whirl::plan {
namespace {

struct CanWindow {
  std::string name, place;
  std::size_t node = 0;
  int bus = 0;
  std::optional<int> sender;             // -1: the microcontroller
  std::optional<std::uint32_t> message;  // a DroneCAN data type
  std::optional<Limit> period, tolerance, load;
  std::int64_t errors = 0;
};

bool is_meant(const CanWindow& w, const results::CanFrameRecord& r) {
  if (w.sender && r.sender != *w.sender) return false;
  return !w.message || r.is_message(*w.message);
}

void judge_can(Script& self, const CanWindow& w, std::int64_t from, std::int64_t to) {
  std::vector<std::int64_t> starts;
  std::int64_t frames = 0, bad = 0;
  double busy_ns = 0.0;
  for (const results::CanFrameRecord& r : self.stage().logs[w.node].can) {
    if (r.bus != w.bus || r.start_ns < from || r.start_ns > to) continue;
    busy_ns += r.busy_ns;
    if (!is_meant(w, r)) continue;
    ++frames;
    bad += r.good ? 0 : 1;
    if (r.good && (!w.message || r.begins)) starts.push_back(r.start_ns);
  }
  const double load = to > from ? busy_ns / static_cast<double>(to - from) : std::nan("");
  char text[64];
  std::snprintf(text, sizeof text, "%lld frames, bus load %.3g %%", static_cast<long long>(frames),
                100.0 * load);
  if (w.period) {
    judge_spread(self, deviations(starts, from, to, w.period->value_SI, w.tolerance->value_SI),
                 *w.tolerance, w.name + " period deviation", w.place, to);
  }
  if (w.load) {
    self.judge_in_window({load, Dimension::ratio, w.name + " load"}, Script::Figure::extreme,
                         *w.load, w.place, seconds(to), text);
  }
  // Of nothing that was sent nothing failed: that is not shown.
  const double errors = frames == 0 ? std::nan("") : static_cast<double>(bad);
  self.judge_in_window({errors, Dimension::none, w.name + " errors"}, Script::Figure::extreme,
                       Limit{static_cast<double>(w.errors), ""}, w.place, seconds(to), text);
}

void read_place(lua_State* L, Script& self, const lua::Table& given, CanWindow& w) {
  const std::string text = given.text("bus");
  const NodePlace at = node_at(L, self, text);
  const BoardDescription& board = self.stage().nodes[at.node].board;
  const auto number = bus_number(at.rest);
  if (!at.rest.starts_with("can") || !number) {
    raise(L, "'" + text + "' is no CAN bus", "write it as \"can1\"");
  }
  if (const auto& joined = self.stage().nodes[at.node].joined; joined.count(at.rest) != 0) {
    raise(L, "'" + text + "' is part of " + joined.at(at.rest),
          "bus = \"" + joined.at(at.rest) + "\"");
  }
  const auto on_it = [&at](const BoardDevice& device) { return device_bus(device) == at.rest; };
  if (std::none_of(board.devices.begin(), board.devices.end(), on_it)) {
    raise(L, "no device of " + board.name + " is on " + at.rest);
  }
  must_see(L, self, at.rest);
  w.name = text;
  w.node = at.node;
  w.bus = *number;
  if (!given.has("from")) return;
  const std::string from = given.text("from");
  const BoardDevice* device = board.find(from);
  if (from != "mcu" && (device == nullptr || !on_it(*device))) {
    raise(L, "'" + from + "' is no node of " + at.rest, "\"mcu\", or a device that is on it");
  }
  w.sender = from == "mcu" ? -1 : board.number(from);
  w.name += " " + from;
}

// t:can { bus = "can2", from = "mcu", message = 1030, period = "20 ms", tolerance = "0.5 ms" }
int can(lua_State* L) {
  Script& self = Script::of(L);
  must_offer(L, self, "can");
  const lua::Table given = check_table(L, 2);
  CanWindow w;
  w.place = place_of(L);
  read_place(L, self, given, w);
  if (given.has("message")) {
    w.message = static_cast<std::uint32_t>(given.integer_or("message", 0, 0));
    w.name += " message " + std::to_string(*w.message);
  }
  w.period = optional_period(given);
  w.tolerance = optional_limit(given, "tolerance", Dimension::time);
  w.load = optional_limit(given, "load", Dimension::ratio, kShare);
  w.errors = given.integer_or("errors", 0, 0);
  const std::int64_t end = window_end(self, given);
  check_finish(L, given);
  if (w.period.has_value() != w.tolerance.has_value()) raise(L, "period and tolerance go together");
  if (w.load && (w.sender || w.message))
    raise(L, "load is of the whole bus", "leave out from and message");
  self.add_window(end, [w](Script& script, std::int64_t from, std::int64_t to) {
    judge_can(script, w, from, to);
  });
  return 0;
}

}  // namespace

void add_can_calls(lua_State* L) {
  const luaL_Reg calls[] = {{"can", can}, {nullptr, nullptr}};
  luaL_setfuncs(L, calls, 0);
}

}  // namespace whirl::plan
