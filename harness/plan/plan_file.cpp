#include "harness/plan/plan_file.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <lua.hpp>
#include <optional>

#include "base/text.hpp"
#include "harness/board/wire_ends.hpp"
#include "harness/lua/node.hpp"
#include "harness/plan/raise.hpp"
#include "io_bridges/board_description/bus_kind.hpp"
#include "io_bridges/board_description/bus_name.hpp"

namespace whirl::plan {
namespace {

constexpr std::size_t kMost_nodes = 16;
constexpr std::int64_t kDefaultTimeout_ns = 120'000'000'000;
// Of a line from a follower to its leader.
constexpr std::int64_t kLeastLatency_ns = 2000, kUsualLatency_ns = 100'000,
                       kMostLatency_ns = 1'000'000;
// Of a UART between boards, the fastest that the follower may speak.
constexpr double kUsualFastest_baud = 115'200.0;
constexpr double kLeastFastest_baud = 1200.0, kMostFastest_baud = 3e6;
const std::vector<std::string> kSurroundings = {"start",     "room",  "outdoors", "fence",
                                                "obstacles", "field", "air",      "load"};

PlanNode read_node(const lua::Table& t) {
  return {"",
          t.text("image"),
          t.text_or("board", "px4fmu_v1"),
          t.texts("watch"),
          t.flag_or("may_reset", false),
          t.texts("flash")};
}

// Names stand before a slash, in file names and in front of a dot.
bool is_node_name(const std::string& name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !name.empty() && name.size() <= 32 && std::all_of(name.begin(), name.end(), plain);
}

// "fc.esc1": node and what is on it.
std::optional<std::pair<std::size_t, std::string>> place_on_node(const std::string& text,
                                                                 const Plan& plan) {
  const auto dot = text.find('.');
  const auto node = std::find_if(plan.nodes.begin(), plan.nodes.end(),
                                 [&](const PlanNode& n) { return n.name == text.substr(0, dot); });
  if (node == plan.nodes.end() || dot == std::string::npos) return {};
  return std::pair(static_cast<std::size_t>(node - plan.nodes.begin()), text.substr(dot + 1));
}

// "esc.usart1"
PlanWire::End wire_end(const lua::Table& t, const char* key, const Plan& plan) {
  PlanWire::End end;
  const auto place = place_on_node(t.text(key), plan);
  const std::string bus = place ? place->second : "";
  const auto number = is_uart(bus) ? bus_number(bus) : std::nullopt;
  if (!number) {
    t.refuse(key, "'" + t.text(key) + "' is no UART of a node", "write NODE.usart1");
    return end;
  }
  end.node = place->first;
  end.uart = static_cast<std::uint16_t>(*number);
  return end;
}

std::int64_t read_latency_ns(const lua::Table& t) {
  const std::int64_t latency_ns = t.duration_ns_or("latency", kUsualLatency_ns);
  if (latency_ns < kLeastLatency_ns || latency_ns > kMostLatency_ns) {
    t.refuse("latency", "a line's latency is 2 us to 1 ms");
  }
  return latency_ns;
}

// "i2c2"; not "i2c02", which would be a second name of it.
bool is_bus_name(const std::string& bus) {
  const auto number = bus_number(bus);
  const auto letters = bus.substr(0, bus.find_last_not_of("0123456789") + 1);
  return number && *number > 0 && bus == letters + std::to_string(*number);
}

void read_board_wire(const lua::Table& t, Plan& plan) {
  const auto from = place_on_node(t.text("from"), plan), to = place_on_node(t.text("to"), plan);
  if (!from) t.refuse("from", "'" + t.text("from") + "' is on no node", "write NODE.DEVICE");
  if (!to) t.refuse("to", "'" + t.text("to") + "' is on no node", "write NODE.i2c2");
  if (!from || !to) return;
  if (from->first == to->first) t.refuse("to", "a wire joins two boards");
  if (!is_bus_name(to->second))
    t.refuse("to", "'" + to->second + "' names no bus", "write NODE.i2c2");
  PlanBoardWire wire{from->first, from->second, to->first, to->second};
  if (to->second.starts_with("spi")) {
    wire.select = t.text("select");
    wire.ready = t.text_or("ready", "");
    if (!wire.ready.empty() && wire.ready == wire.select)
      t.refuse("ready", "is the pin of select: a pin has one wire");
    wire.latency_ns = read_latency_ns(t);
  } else if (bus_kind(to->second) == BusKind::dac) {
    wire.latency_ns = read_latency_ns(t);
  } else if (is_uart(to->second)) {
    const double fastest = t.quantity_or("fastest", Dimension::baud, kUsualFastest_baud,
                                         lua::between(kLeastFastest_baud, kMostFastest_baud));
    wire.latency_ns = shortest_character_ns(fastest);
  }
  plan.board_wires.push_back(std::move(wire));
}

void read_wires(const lua::Table& t, Plan& plan) {
  for (const lua::Table& entry : t.tables("wires")) {
    const std::string from = entry.text("from");
    if (!is_uart(from.substr(from.find('.') + 1))) {  // a device's place
      read_board_wire(entry, plan);
      continue;
    }
    const PlanWire wire{wire_end(entry, "from", plan), wire_end(entry, "to", plan)};
    if (wire.a.node == wire.b.node) entry.refuse("to", "a wire joins two boards");
    plan.wires.push_back(wire);
  }
}

void read_nodes(const lua::Table& t, Plan& plan) {
  if (!t.has("nodes")) {
    plan.nodes.push_back(read_node(t));
    return;
  }
  for (const char* key : {"image", "board", "watch", "may_reset", "flash"}) {
    if (t.has(key)) t.refuse(key, "stands in each of the nodes");
  }
  for (const lua::Table& entry : t.tables("nodes")) {
    PlanNode node = read_node(entry);
    node.name = entry.text("name");
    if (!is_node_name(node.name)) entry.refuse("name", "is made of a-z, 0-9 and _ only");
    for (const PlanNode& other : plan.nodes) {
      if (other.name == node.name) entry.refuse("name", "two nodes are called so");
    }
    plan.nodes.push_back(std::move(node));
  }
  if (plan.nodes.empty() || plan.nodes.size() > kMost_nodes) {
    t.refuse("nodes", "are 1 to " + std::to_string(kMost_nodes));
  }
  if (t.has("wires")) read_wires(t, plan);
}

// vehicle_with = { rotor_drag_s_per_m = 0.03 }: as --set vehicle.rotor_drag_s_per_m=0.03 does.
Settings read_vehicle_settings(const lua::Table& changes) {
  Settings settings;
  for (const std::string& key : changes.keys()) {
    std::string value;
    if (changes.kind(key) == lua::Kind::text) {
      value = changes.text(key);
    } else {
      char digits[32];
      std::snprintf(digits, sizeof digits, "%.17g", changes.number(key));
      value = digits;
    }
    settings.push_back({"vehicle." + key, value});
  }
  return settings;
}

Result<Plan> read_plan(const lua::Table& t, std::string name, const std::string& file,
                       const std::string& place) {
  Plan plan;
  plan.name = std::move(name);
  plan.file = file;
  plan.place = place;
  read_nodes(t, plan);
  plan.vehicle = t.text_or("vehicle", "");
  if (t.has("stand")) plan.stand = t.table("stand");
  if (t.has("vehicle") == t.has("stand")) {
    t.refuse("vehicle", "a plan has a vehicle or a stand, one of the two");
  }
  if (t.has("vehicle_with")) {
    if (plan.stand) t.refuse("vehicle_with", "belongs to a vehicle, not to a stand");
    plan.vehicle_settings = read_vehicle_settings(t.table("vehicle_with"));
  }
  plan.tags = t.texts("tags");
  plan.seed = static_cast<std::uint64_t>(t.integer_or("seed", 1, 0));
  plan.timeout_ns = t.duration_ns_or("timeout", kDefaultTimeout_ns);
  if (plan.timeout_ns == 0) t.refuse("timeout", "is 0: no plan could end before it");
  if (t.has("late")) plan.late_ns = t.duration_ns("late");
  if (t.has("late_share")) {
    plan.late_share = t.quantity("late_share", Dimension::ratio, lua::between(0.0, 1.0));
  }
  // What stand and surroundings are made of is read (and their unknown keys refused) by who makes them.
  std::vector<std::string> elsewhere{"stand"};
  for (const std::string& key : kSurroundings) {
    if (t.has(key) && plan.stand) t.refuse(key, "belongs to a vehicle, not to a stand");
    elsewhere.push_back(key);
  }
  if (!plan.stand) plan.surroundings = t;
  if (auto good = t.finish_except(elsewhere); !good) return good.error();
  return plan;
}

// What was set for the plan, and for its stand, which is a table of the plan.
Result<Done> put_settings(const Settings& settings, lua::Table& plan) {
  for (const Setting& setting : settings) {
    const std::string_view of_plan = path_in(setting, "plan");
    const std::string_view path = path_in(setting, "stand").empty() ? of_plan : setting.key;
    if (path.empty()) continue;
    if (const auto set = plan.put(path, setting.value); !set) return set;
  }
  return Done{};
}

// Names stand in one line of a terminal and choose plans on command lines. Null: nothing is wrong.
const char* fault_of_name(const std::string& name) {
  if (name.empty()) return "is empty";
  if (name.size() > 200) return "is longer than 200 bytes";
  if (name != printable_line(name)) return "holds control characters, or is no UTF-8";
  return nullptr;
}

}  // namespace

Plan plan_of_one_board(const std::string& name, const std::string& place) {
  Plan plan;
  plan.name = name;
  plan.file = plan.place = place;
  plan.nodes.emplace_back();
  return plan;
}

bool Plan::has_tag(const std::string& tag) const {
  return std::find(tags.begin(), tags.end(), tag) != tags.end();
}

// plan "name" { ... }: the call with the name gives a function that takes the table.
int PlanFile::declare(lua_State* L) {
  if (lua_type(L, 1) != LUA_TSTRING || lua_gettop(L) != 1) {
    return luaL_error(L, "write it as: plan \"name\" { ... }");
  }
  lua_pushcclosure(L, add_plan, 1);
  return 1;
}

namespace {

// A chunk is called by its file's name.
bool is_of_file(const lua_Debug& function, const std::string& path) {
  return std::filesystem::path(path).filename().string() == std::string(function.source).substr(1);
}

}  // namespace

int PlanFile::add_plan(lua_State* L) {
  auto* self = static_cast<PlanFile*>(lua::Sandbox::owner(L));
  std::size_t size = 0;
  const char* text = lua_tolstring(L, lua_upvalueindex(1), &size);
  const std::string name(text, size);
  if (const char* fault = fault_of_name(name)) return luaL_error(L, "plan: its name %s", fault);
  if (!lua_istable(L, 1))
    return luaL_error(L, "plan \"%s\": a table { ... } is wanted", name.c_str());
  if (lua_getfield(L, 1, "run") != LUA_TFUNCTION) {
    return luaL_error(L, "plan \"%s\": run = function(t) ... end is missing", name.c_str());
  }
  lua_pushvalue(L, -1);
  lua_Debug run{};
  lua_getinfo(L, ">S", &run);
  const int run_ref = luaL_ref(L, LUA_REGISTRYINDEX);
  lua_pushnil(L);
  lua_setfield(L, 1, "run");
  const std::string place = place_of(L);
  const auto tree = lua::tree_from_stack(L, 1, self->path_, "", place);
  if (!tree) raise(L, tree.error());
  lua::Table table(tree.value(), &tree.value()->root);
  if (auto set = put_settings(self->settings_, table); !set) raise(L, set.error());
  auto plan = read_plan(table, name, self->path_, place);
  if (!plan) raise(L, plan.error());
  for (const Plan& other : self->plans_) {
    if (other.name == name) return luaL_error(L, "two plans are called \"%s\"", name.c_str());
  }
  plan.value().run_ref = run_ref;
  // A function of another file has no calls here; they are checked when they are made.
  if (is_of_file(run, self->path_)) {
    plan.value().calls =
        source_calls(self->sandbox_.source(), run.linedefined, run.lastlinedefined);
    plan.value().words =
        source_words(self->sandbox_.source(), run.linedefined, run.lastlinedefined);
  }
  self->plans_.push_back(std::move(plan.value()));
  return 0;
}

Result<std::unique_ptr<PlanFile>> PlanFile::load(const std::string& path, lua::Limits limits,
                                                 const Settings& settings, const Instead& instead) {
  std::unique_ptr<PlanFile> file(new PlanFile(path, limits, settings));
  file->sandbox_.put_instead(instead.file_name, instead.path);
  file->sandbox_.set_owner(file.get());
  const auto registered =
      file->sandbox_.protect(0, [](lua_State* L) { lua_register(L, "plan", declare); });
  if (!registered) return registered.error();
  if (auto ran = file->sandbox_.run_file(path); !ran) return ran.error();
  if (file->plans_.empty()) {
    return Error{ErrorKind::bad_input, path, "declares no plan", "write: plan \"name\" { ... }"};
  }
  return file;
}

}  // namespace whirl::plan
