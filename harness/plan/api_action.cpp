// t:command, t:gust, t:fault: what a plan does to the world and to the board.
#include <algorithm>

#include "harness/plan/bus_name.hpp"
#include "harness/plan/raise.hpp"
#include "harness/plan/requests.hpp"
#include "harness/plan/values.hpp"

namespace whirl::plan {
namespace {

// What t:command and t:gust share: the table goes to the world, or the plan's line to the complaint.
int pass_on(lua_State* L, Result<Done> (*to_world)(World&, const lua::Table&, std::int64_t)) {
  const Stage& stage = Script::of(L).stage();
  const lua::Table table = check_table(L, 2);
  if (auto done = to_world(stage.world, table, stage.now_ns); !done) raise(L, done.error());
  return 0;
}

int command(lua_State* L) {
  return pass_on(L, plan::command);
}

int gust(lua_State* L) {
  return pass_on(L, disturb);
}

int named_bus(lua_State* L, const std::string& bus) {
  const auto number = bus_number(bus);
  if (!number) raise(L, "'" + bus + "' is no bus", "write it as \"i2c3\", \"spi1\" or \"usart2\"");
  return *number;
}

void place_fault(lua_State* L, const lua::Table& wish, const Board& board, FaultSpec& fault) {
  if (wish.has("device")) {
    fault.device = wish.text("device");
    const BoardDevice* device = board.find(fault.device);
    if (device == nullptr) raise(L, "unknown device '" + fault.device + "' on " + board.name);
    fault.bus = named_bus(L, device->bus);
    fault.address = device->address != -1 ? device->address : board.number(fault.device);
  }
  if (wish.has("bus")) fault.bus = named_bus(L, wish.text("bus"));
  if (wish.has("address")) fault.address = static_cast<int>(wish.integer("address", 0, 0x7F));
  if (wish.has("function")) {
    const std::string function = wish.text("function");
    fault.address = board.watch_number(function);
    if (fault.address < 0) {
      raise(L, "'" + function + "' is not watched", "add it to the watch list");
    }
  }
  if (wish.has("motor")) fault.address = static_cast<int>(wish.integer("motor", 1, 4));
}

constexpr const char* kAxes[] = {"accel_x", "accel_y", "accel_z", "gyro_x", "gyro_y", "gyro_z"};

int axis_number(const lua::Table& wish) {
  const std::string word = wish.choice("axis", {std::begin(kAxes), std::end(kAxes)});
  return static_cast<int>(std::find(std::begin(kAxes), std::end(kAxes), word) - std::begin(kAxes));
}

// t:fault { kind = "i2c_nack", device = "esc2", start = "0 s", duration = "100 ms", value = 1 }
// Without a duration it stays for ever. start counts from now.
int fault(lua_State* L) {
  Script& self = Script::of(L);
  const lua::Table wish = check_table(L, 2);
  FaultSpec fault;
  fault.kind = wish.text("kind");
  place_fault(L, wish, self.stage().board, fault);
  if (wish.has("axis")) fault.axis = axis_number(wish);
  fault.start_ns = self.stage().now_ns + wish.duration_ns_or("start", 0);
  if (wish.has("duration")) fault.end_ns = fault.start_ns + wish.duration_ns("duration");
  if (wish.has("value")) fault.value = wish.any_quantity("value").value_SI;
  check_finish(L, wish);
  fault.number = static_cast<std::uint32_t>(self.faults.size() + 1);
  self.faults.push_back(fault);
  self.fault_targets.push_back(
      !fault.device.empty() ? fault.device : wish.text_or("bus", wish.text_or("function", "")));
  if (!self.stage().world.take_fault(fault)) {
    if (auto sent = self.stage().inject(fault); !sent) raise(L, sent.error());
  }
  return 0;
}

}  // namespace

void add_action_calls(lua_State* L) {
  const luaL_Reg calls[] = {
      {"command", command}, {"gust", gust}, {"fault", fault}, {nullptr, nullptr}};
  luaL_setfuncs(L, calls, 0);
}

}  // namespace whirl::plan
