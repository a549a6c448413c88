-- The first flight, flown by five unmodified images: take off to 1.1 m, hover through a sideways gust, land. Limits
-- are those of test_plans/flight/hover.lua, but for what the controllers' own boards add: their tasks, and the energy.
include "include/chain.lua"
include "include/flights.lua"
include "include/hover.lua"

local function i2c_windows(t)
  for _, esc in ipairs(escs) do
    t:bus { device = "flight/" .. esc, direction = "write", period = "20 ms", tolerance = "0.5 ms", during = "20 s" }
    t:bus { device = "flight/" .. esc, direction = "read", period = "50 ms", tolerance = "1 ms", during = "20 s" }
  end
end

chain_plan("chain hover", { timeout = "60 s", parity = true, of_escs = { "fw::esc::control_task" } }, function(t, boards)
  t:step "boot"
  heartbeat(t)
  judged_hover(t, boards, i2c_windows)
end)
