// What flights of the real image begin with, as Lua in front of a plan's text.
#pragma once
#include <string>

namespace whirl {

inline const std::string kFlightSteps = R"(
local function ready_on_can(t)
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  for _, name in ipairs { "SENS_BUS", "ESC_BUS" } do
    t:command { parameter = { name = name, value = 1 } }
    t:within("3 s", function(s) return s.parameter_pending == 0 end, name .. " is answered")
  end
  t:within("8 s", function(s) return s.told_ready == 1 end, "it says that it can be armed")
end

local function up_by_the_sticks(t)
  t:command { rc = { mode = 2 } }
  t:wait "1 s"
  t:command { rc = { arm = true } }
  t:within("2 s", function(s) return s.told_armed == 1 end, "armed by the switch")
  t:wait "1 s"
  t:command { rc = { thrust = "100 %" } }
  t:within("8 s", function(s) return s.height_m > 0.5 end, "up")
end

)";

}  // namespace whirl
