// What windows on times have in common: t:budget, t:bus, t:can, t:latency.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/lua/table.hpp"
#include "harness/metrics/timing.hpp"
#include "harness/plan/script.hpp"
#include "harness/plan/values.hpp"

namespace whirl::plan {

std::string in_text(double x_s, const std::string& unit);
// "p50 3 us, p99 8 us, 1000 values"
std::string spread(const metrics::Distribution& d, const std::string& unit);

// A share of a time as a limit: no more than all of it is ever taken.
inline constexpr lua::Range kShare{.low = 0.0, .high = 1.0, .high_open = true};
std::optional<Limit> optional_limit(const lua::Table& given, const char* key, Dimension dimension,
                                    const lua::Range& range = lua::at_least(0.0));
std::optional<Limit> optional_period(const lua::Table& given);
std::int64_t window_end(Script& self, const lua::Table& given);

// The period of what happens at `times` in [from, to]: with its deviation from nominal. The edges
// count too: a thing that stopped, or never began, has a gap there. A gap of all the window that is within the
// tolerance says nothing of what never came: then there are none.
std::vector<double> deviations(std::span<const std::int64_t> times, std::int64_t from,
                               std::int64_t to, double nominal_s, double tolerance_s);
void judge_spread(Script& self, std::span<const double> values, const Limit& limit,
                  const std::string& name, const std::string& place, std::int64_t to_ns,
                  Script::Figure figure = Script::Figure::extreme);

NodePlace node_at(lua_State* L, Script& self, const std::string& text);
// Also for calls that stand where no text shows them: in a function of another file.
void must_offer(lua_State* L, Script& self, const std::string& call);
// "i2c3", "pin_NAME": of a log of buses that sees some of them only.
void must_see(lua_State* L, Script& self, const std::string& wires);

inline constexpr const char* kUnread = "frames on this bus could not be read";
// A frame that an analyser saw and could not read may be the one that a figure misses.
bool unread_between(const results::EventLog& log, bool spi, int bus, std::int64_t from,
                    std::int64_t to);

}  // namespace whirl::plan
