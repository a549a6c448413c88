-- The rotor is held before it turns: no current beyond the limits, then the motor is off and stays so.
-- Left out: a rotor braked while it turns. Stopped from 5200 RPM within 25 ms it takes 35 A: the sensed speed lags.
include "include/start.lua"

local function safe(t, record, words)
  t:expect(record:max "winding_peak", "winding current, " .. words):at_most "30 A"
  t:expect(record:max "bus_peak", "bus current, " .. words):at_most "22 A"
end

-- Off although the rotor is free and set-points go on.
local function latched(t)
  t:step "latched"
  t:command { brake = "0 N m" }
  local off = t:record({ "winding_peak", "speed" }, "1 s")
  t:expect(off:max "winding_peak", "winding current, latched"):at_most "0.1 A"
  t:expect(off:final "speed", "stands"):at_most "20 rad/s"
  t:expect(t:value "armed", "disarmed"):equal(0)
  t:expect(t:value "shoot_through", "legs shorted"):equal(0)
end

local function stall_plan(name, run)
  plan(name) {
    image = "esc", board = "esc32v2",
    stand = { prop = "hk_10x4.5", battery = "4s_2200" },
    tags = { "esc" },
    timeout = "20 s",
    run = run,
  }
end

stall_plan("stall_at_start", function(t)
  t:step "start against the brake"
  t:within("3 s", function(s) return s.armed == 1 end, "armed after its zeros")
  t:command { brake = "1 N m" }
  local held = t:record({ "winding_peak", "bus_peak", "speed" }, "3 s", function()
    t:command { thrust = "2 N" }
  end)
  t:expect(held:max "winding_peak", "winding current, tried to start"):at_least "5 A"
  safe(t, held, "starting")
  latched(t)
end)
