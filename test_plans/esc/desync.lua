-- Synchronism lost while the rotor turns or stops: found out, told, and the rotor caught or started anew as soon as
-- it can turn. Six losses in a row are too many.
-- Left out: a phase that senses wrong (no fault of that kind).
include "include/start.lua"

local function desync_plan(name, run)
  plan(name) {
    image = "esc", board = "esc32v2",
    stand = { prop = "hk_10x4.5", supply = "16.8 V" },
    tags = { "esc", "faults" },
    timeout = "20 s",
    run = run,
  }
end

local signals = { "winding_peak", "bus_peak", "speed" }

-- Stops the rotor and lets go of it after a while.
local function stop_for(t, duration, words)
  local stop = t:record(signals, duration, function() t:command { brake = "1.3 N m" } end)
  t:command { brake = "0 N m" }
  safe(t, stop, words)
end

desync_plan("desync_restart", function(t)
  start(t, "4 N")
  t:within("60 ms", function(s) return not flag(s.esc_flags, 5) end, "in synchronism before")
  t:step "stopped"
  stop_for(t, "100 ms", "stopped")
  t:expect(t:value "speed", "stands"):at_most "1 rad/s"
  t:within("60 ms", function(s) return flag(s.esc_flags, 5) end, "told as loss of synchronism")
  t:expect(t:value "armed", "still armed"):equal(1)
  t:step "started anew"
  local again = t:record(signals, "1 s")
  safe(t, again, "started anew")
  t:within("500 ms", function(s) return s.thrust_N > 3.8 end, "back at its thrust")
  t:within("100 ms", function(s) return not flag(s.esc_flags, 5) end, "told as in synchronism")
  t:expect(t:value "shoot_through", "legs shorted"):equal(0)
end)

-- Jerked from 4 N to about half of its speed within 5 ms: if synchronism is lost, the rotor is caught as it turns.
desync_plan("desync_jerk", function(t)
  start(t, "4 N")
  t:step "jerk"
  local jerk = t:record(signals, "5 ms", function() t:command { brake = "2 N m" } end)
  t:command { brake = "0 N m" }
  t:expect(jerk:min "speed", "slowest"):within("100 rad/s", "400 rad/s")
  local again = t:record(signals, "300 ms")
  safe(t, jerk, "jerk")
  safe(t, again, "afterwards")
  t:expect(again:min "speed", "never stands"):at_least "60 rad/s"
  t:expect(t:value "thrust", "thrust after 0.3 s"):at_least "3.8 N"
  t:expect(t:value "armed", "still armed"):equal(1)
  t:expect(t:value "shoot_through", "legs shorted"):equal(0)
end)

desync_plan("desync_too_often", function(t)
  start(t, "4 N")
  for loss = 1, 6 do
    t:step("loss " .. loss)
    t:expect(t:value "armed", "armed before loss " .. loss):equal(1)
    stop_for(t, "50 ms", "loss " .. loss)
    if loss < 6 then t:within("1 s", function(s) return s.thrust_N > 3 end, "turns again after loss " .. loss) end
  end
  t:wait "100 ms"
  local off = t:record(signals, "1 s")
  t:expect(off:max "winding_peak", "winding current after the sixth"):at_most "0.1 A"
  t:expect(t:value "armed", "disarmed"):equal(0)
  t:expect(t:value "shoot_through", "legs shorted"):equal(0)
end)
