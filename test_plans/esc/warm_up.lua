-- The current sense warms up: its offset drifts for some 100 s after power-up. What was zeroed at once is wrong in
-- flight; zeroed again at rest after the drift, gain and wander remain.
include "include/start.lua"

-- What the ESC tells less what flows, and what flows: means of four seconds.
local function compare(t)
  local error_A, current_A, n = 0, 0, 200
  for _ = 1, n do
    t:wait "20 ms"
    local flows = t:value("bus_current", "A")
    error_A = error_A + (t:value("told_current", "A") - flows) / n
    current_A = current_A + flows / n
  end
  return error_A, current_A
end

plan "current_sense_warm_up" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", supply = "16 V" },
  tags = { "esc", "nightly" },
  timeout = "400 s",
  run = function(t)
    start(t, "2 N")
    t:step "cold"
    local cold_A = compare(t)
    t:expect(math.abs(cold_A), "error at once, A"):at_most(0.3)
    t:step "warms up in flight"
    t:wait "145 s"
    local warm_A = compare(t)
    t:expect(math.abs(warm_A - cold_A), "drift in the first 150 s, A"):at_least(0.1)
    t:step "zeroed at rest"
    t:command { stop = true }
    t:within("5 s", function(s) return s.speed_radps < 20 end, "stands")
    t:wait "15 s"
    start(t, "2 N")
    local zeroed_A, current_A = compare(t)
    t:expect(math.abs(zeroed_A), "error after that, A"):at_most(0.05 + 0.1 * current_A)
    t:step "settled"
    t:wait "100 s"
    local later_A = compare(t)
    t:expect(math.abs(later_A - zeroed_A), "drift in the next 100 s, A"):at_most(0.05)
  end,
}
