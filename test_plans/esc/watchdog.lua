-- The control task hangs while sampling and commutation go on: the watchdog resets the part, the motor is
-- off within 0.6 s, and set-points alone do not start it again.
include "include/start.lua"

plan "watchdog" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", battery = "4s_2200" },
  tags = { "quick", "esc", "faults" },
  timeout = "20 s", may_reset = true,
  run = function(t)
    start(t, "2 N")
    t:expect(t:value "resets", "resets before"):equal(0)
    t:step "hangs"
    t:fault { kind = "code_hangs", ["function"] = "fw::esc::control_task", duration = "300 ms" }
    t:within("300 ms", function(s) return s.resets >= 1 end, "reset by its watchdog")
    t:wait_until(function() return false end, "300 ms")
    local off = t:record({ "winding_peak", "speed" }, "2 s")
    t:expect(off:max "winding_peak", "winding current from 0.6 s on"):at_most "0.1 A"
    t:expect(off:final "speed", "stands"):at_most "20 rad/s"
    t:expect(t:value "armed", "disarmed"):equal(0)
    t:expect(t:value "shoot_through", "legs shorted"):equal(0)
    t:step "armed anew"
    t:command { stop = true }
    t:within("2 s", function(s) return s.armed == 1 end, "armed by its zeros")
    t:command { thrust = "2 N" }
    t:wait "2 s"
    t:expect(t:value "thrust", "flies again"):within("1.8 N", "2.2 N")
    t:expect(t:value "resets", "resets in all"):at_most(2)
  end,
}
