-- The image keeps its times in every mode while the rotor turns and changes its speed, up to 6000 RPM.
-- The converter's instant moves with the duty, to the end of the PWM's on phase: it is judged while
-- the duty stands. By power the work is most: the stream runs, and a downdraft that Algorithm 1 has to find.
include "include/start.lua"
include "include/calibration.lua"

-- In a downdraft that power tells: not at 2 N, where the current has gaps (rise_by_power.lua).
local function by_power(t)
  calibrate(t)
  for _, line in ipairs { "set warm_up 0", "stream 100" } do t:ask(line, "^ok$") end
  t:gust { down = "4 m/s" }
end

local function timing(mode, number, low, high, prepare)
  plan("timing_" .. mode) {
    image = "esc", board = "esc32v2",
    stand = { prop = "hk_10x4.5", battery = "4s_2200", mode = mode, shunt = { warm_up = "0 A" } },
    watch = { "fw::esc::sampling_task", "fw::esc::commutation_task", "adc1" },
    tags = { number == 2 and "quick" or "nightly", "esc", "timing" },
    timeout = "20 s",
    run = function(t)
      t:wait "50 ms"
      if prepare then prepare(t) end
      t:command { line = "mode " .. number }
      start(t, low)
      t:step "steady"
      t:budget("adc1") { period = "50 us", jitter = "5 us", during = "1 s", margin = "10 %" }
      t:budget("fw::esc::control_task") {
        period = "1 ms", jitter = "20 us", latency = "20 us", response = "500 us", during = "3 s", margin = "10 %",
      }
      t:budget("fw::esc::sampling_task") { latency = "10 us", response = "10 us", during = "3 s", margin = "10 %" }
      t:budget("fw::esc::commutation_task") { latency = "10 us", response = "10 us", during = "3 s", margin = "10 %" }
      t:budget("cpu") { busy = "60 %", during = "3 s", margin = "10 %" }
      t:budget("stack") { depth = "2 KiB", margin = "10 %" }
      if prepare then
        local r = t:record({ "esc_observable", "esc_iterations" }, "1 s")
        t:expect(r:mean "esc_observable", "share of the time that power tells the inflow"):at_least(0.99)
        t:expect(r:max "esc_iterations", "iterations of Algorithm 1"):at_most(6)
      else
        t:wait "1 s"
      end
      t:step "faster"
      t:command(high)
      t:wait "1 s"
      t:expect(t:value("speed"), "as fast as asked"):at_least(number == 1 and "5950 rpm" or "5000 rpm")
      t:step "slower"
      t:command(low)
      t:wait "1 s"
      t:expect(t:value "armed", "still armed"):equal(1)
    end,
  }
end

timing("duty", 0, { duty = "30 %" }, { duty = "55 %" })
timing("rpm", 1, { speed = "3500 rpm" }, { speed = "6000 rpm" })
timing("thrust_by_rpm", 2, { thrust = "2 N" }, { thrust = "4 N" })
timing("power", 4, { power = "20 W" }, { power = "40 W" }, by_power)
timing("thrust_by_power", 5, { thrust = "2.4 N" }, { thrust = "4 N" }, by_power)
