-- A motor that takes more than the image can foresee: 1400 Kv where 950 are believed, so that the model's bound on
-- voltage allows too much. The guard at the PWM's rate holds the current, and trips where that lasts.
include "include/start.lua"

local function limited(name, motor, run)
  plan(name) {
    image = "esc", board = "esc32v2",
    stand = { prop = "hk_10x4.5", supply = "16.8 V", motor = motor },
    tags = { "esc", "faults" },
    timeout = "20 s",
    run = function(t)
      t:wait "200 ms"
      t:ask("set max_current 12", "^ok$")
      start(t, "1 N")
      run(t)
      t:expect(t:value "shoot_through", "legs shorted"):equal(0)
    end,
  }
end

local signals = { "thrust", "winding_peak", "bus_peak" }

local function demand(t)
  t:step "more than it can give"
  local record = t:record(signals, "1500 ms", function() t:command { thrust = "8 N" } end)
  safe(t, record)
  return record
end

limited("over_current_wrong_motor", { kv_rpm_per_V = 1400 }, function(t)
  local record = demand(t)
  t:expect(record:max "winding_peak", "it tries"):at_least "14 A"
  t:within("10 ms", function(s) return flag(s.esc_flags, 3) end, "told as over-current")
  t:expect(t:value "armed", "disarmed"):equal(0)
  t:step "latched"
  local off = t:record(signals, "1 s")
  t:expect(off:max "winding_peak", "winding current, latched"):at_most "0.1 A"
  t:step "cleared by zeros"
  t:command { stop = true }
  t:within("2 s", function(s) return s.armed == 1 and not flag(s.esc_flags, 3) end, "armed again")
  start(t, "1 N")
  t:expect(t:value "thrust", "turns again"):within("0.9 N", "1.2 N")
end)

-- The same demand on the motor that the image knows: it saturates at its limit and goes on.
limited("over_current_none", {}, function(t)
  local record = demand(t)
  t:expect(record:max "winding_peak", "a limit of 12 A"):at_most "22 A"
  t:expect(record:final "thrust", "gives what it can"):at_least "4 N"
  t:expect(t:value "armed", "still armed"):equal(1)
end)
