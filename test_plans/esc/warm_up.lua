-- The current sense warms up: its offset drifts by some 0.5 A within the first 100 s after power-up. What was
-- zeroed at once goes wrong in flight; zeroed again at rest after the drift, only gain and wander remain.
-- The part is one with a drift of one standard deviation and more: see the seed.
include "include/start.lua"

-- Mean of what the ESC tells less what flows, over five seconds.
local function error_A(t)
  local r = t:record({ "told_current", "bus_current" }, "5 s")
  return { error = r:mean "told_current" - r:mean "bus_current", current = r:mean "bus_current" }
end

plan "current_sense_warm_up" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", supply = "16 V" },
  tags = { "esc", "nightly" },
  timeout = "400 s",
  run = function(t)
    start(t, "2 N")
    local cold = error_A(t)
    t:wait "140 s"
    local warm = error_A(t)
    t:expect(warm.error - cold.error, "x"):at_least "0.1 A"
  end,
}
