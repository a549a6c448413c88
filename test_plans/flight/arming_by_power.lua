-- Thrust by power is read off the ESCs' currents, whose zeros drift by 0.4 A (1 sigma) in the first 100 s after power-up: the
-- thesis warms them up before it flies so (section 3.4). When they are warm, each ESC tells: by then 15 mA are still to come
-- (firmware/esc/core/sensing.hpp). By RPM no current has a part in it, and nobody waits.

-- Told to drift by 30 mA in place of 0.4 A, so that nobody waits for 98 s: 15 are left after 30 s ln(30 / 15) = 20.8 s. The
-- shunts themselves do not drift, for what does while still air's power is told before the flight is refused there.
local cold = { ["esc.calibration.warm_up"] = 0.03 }

local function arming(name, more, run)
  plan(name) {
    image = "flight_st", board = "px4fmu_v1", vehicle = "hp_quad_st", vehicle_with = more,
    tags = { "flight" }, timeout = "60 s", run = run,
  }
end

local function refused(t, when)
  t:command { arm = true }
  t:told("3 s", "current sense cold")
  t:expect(t:value "told_armed", "armed " .. when):equal(0)
end

arming("arming by power: refused until the current sensors are warm", cold, function(t)
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  t:wait "3 s"
  refused(t, "some 4 s after power-up")
  t:wait "10 s"
  refused(t, "some 16 s after it")
  t:wait "9 s"
  t:command { arm = true }
  t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
end)

arming("arming by power: at once where they are warm", nil, function(t)
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  t:wait "3 s"
  t:command { arm = true }
  t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
end)
