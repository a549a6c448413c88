-- The rotor is held before it turns, or braked to a standstill while it turns: no current beyond the limits, the
-- motor off while it cannot turn, and off for good after one and a half seconds of tries.
include "include/start.lua"

-- Off although the rotor is free and set-points go on.
local function latched(t)
  t:step "latched"
  t:command { brake = "0 N m" }
  local off = t:record({ "winding_peak", "speed" }, "1 s")
  t:expect(off:max "winding_peak", "winding current, latched"):at_most "0.1 A"
  t:expect(off:final "speed", "stands"):at_most "20 rad/s"
  t:expect(t:value "armed", "disarmed"):equal(0)
  t:within("10 ms", function(s) return flag(s.esc_flags, 5) end, "told as loss of synchronism")
  t:expect(t:value "shoot_through", "legs shorted"):equal(0)
end

local function stall_plan(name, prop, run)
  plan(name) {
    image = "esc", board = "esc32v2",
    stand = { prop = prop, supply = "16.8 V" },
    tags = { "esc" },
    timeout = "20 s",
    run = run,
  }
end

stall_plan("stall_at_start", "hk_10x4.5", function(t)
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

-- Stopped within `stops`, then held.
local function braked(name, thrust, brake, stops, prop)
  stall_plan("stall_" .. name, prop or "hk_10x4.5", function(t)
    start(t, thrust)
    t:step "brake"
    local stop = t:record({ "winding_peak", "bus_peak", "speed" }, stops, function() t:command { brake = brake } end)
    t:expect(t:value "speed", "stopped within " .. stops):at_most "1 rad/s"
    safe(t, stop, "braked")
    t:step "held"
    local held = t:record({ "winding_peak", "bus_peak", "speed" }, "2 s")
    safe(t, held, "held")
    latched(t)
  end)
end

braked("from_4N_in_20ms", "4 N", "1.3 N m", "20 ms")
braked("from_4N_in_13ms", "4 N", "2 N m", "13 ms")
braked("from_4N_in_80ms", "4 N", "0.5 N m", "80 ms")
braked("from_2N_in_20ms", "2 N", "1 N m", "20 ms")
braked("from_7N_in_25ms", "7 N", "1.3 N m", "25 ms")
braked("large_prop", "4 N", "1.3 N m", "20 ms", "apcsf_11x4.7")
