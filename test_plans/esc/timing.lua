-- The image keeps its times while the rotor turns and changes its speed, at up to 4 N (5200 RPM).
-- Left out: from the pin to the entry of an interrupt, the other modes.
include "include/start.lua"

plan "timing_budgets" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", battery = "4s_2200" },
  tags = { "esc" },
  timeout = "20 s",
  run = function(t)
    start(t, "2 N")
    t:step "measured"
    t:budget("fw::esc::control_task") { period = "1 ms", jitter = "20 us", response = "500 us", during = "3 s" }
    t:budget("fw::esc::sampling_task") { response = "10 us", during = "3 s" }
    t:budget("fw::esc::commutation_task") { response = "10 us", during = "3 s" }
    t:budget("cpu") { busy = "60 %", during = "3 s" }
    t:wait "1 s"
    t:command { thrust = "4 N" }
    t:wait "1 s"
    t:command { thrust = "2 N" }
    t:wait "1 s"
    t:expect(t:value "armed", "still armed"):equal(1)
  end,
}
