// The commands and disturbances of a plan, from the tables that it writes. Which world understands which
// of them is the world's matter (world/request.hpp).
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/lua/table.hpp"
#include "harness/world/request.hpp"
#include "harness/world/world.hpp"

namespace whirl::plan {

// What a terminal can be typed: no control characters, and ASCII only.
bool is_one_line(const std::string& text);

// Gives the text of a file that a request names (waypoints).
using ReadFile = std::function<Result<std::string>(const std::string& name)>;

// { arm = true }, { thrust = "2 N", silence = true }: in the order in which a world shall take them.
// Errors   bad_input, with the place of the table: what the table holds is wrong, or nothing
Result<std::vector<Command>> read_commands(const lua::Table& t, const ReadFile& read_file = {});
Result<Disturbance> read_disturbance(const lua::Table& t);

// Reads a table and gives it to the world. What the world refuses is placed as if the table were wrong.
Result<Done> command(World& world, const lua::Table& t, std::int64_t now_ns,
                     const ReadFile& read_file = {});
Result<Done> disturb(World& world, const lua::Table& t, std::int64_t now_ns);
Result<Done> hold(World& world, const lua::Table& t, std::int64_t now_ns);
Result<Done> release(World& world, const lua::Table& t, std::int64_t now_ns);

}  // namespace whirl::plan
