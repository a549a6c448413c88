-- Set-points far more often than at 50 Hz: the loop keeps its millisecond, commutation its urgency, thrust its
-- value, and the ESC still answers when it is asked. 10 kHz is back to back: the wire is hardly ever free.
include "include/start.lua"

local function flood(name, rate)
  plan("setpoint_flood_" .. name) {
    image = "esc", board = "esc32v2",
    stand = { prop = "hk_10x4.5", supply = "16 V" },
    watch = { "fw::esc::sampling_task", "fw::esc::commutation_task" },
    tags = { "esc", "faults", "timing" },
    timeout = "20 s",
    run = function(t)
      start(t, "2 N")
      local calm = string.format("%.4f N", t:value("thrust", "N"))
      t:step "flood"
      t:command { setpoint_rate = rate }
      t:budget("fw::esc::control_task") {
        period = "1 ms", jitter = "20 us", latency = "20 us", response = "500 us", during = "2 s", margin = "10 %",
      }
      t:budget("fw::esc::sampling_task") { latency = "10 us", during = "2 s", margin = "10 %" }
      t:budget("fw::esc::commutation_task") { latency = "10 us", during = "2 s", margin = "10 %" }
      t:budget("cpu") { busy = "60 %", during = "2 s", margin = "10 %" }
      local flooded = t:record({ "thrust" }, "1 s")
      t:expect(flooded:max_error { thrust = calm }, "thrust off its value")
        :at_most "0.04 N"
      local rise = t:record({ "thrust", "bus_peak" }, "1 s", function() t:command { thrust = "3.2 N" } end)
      t:expect(rise:rise_time "thrust", "thrust rise, 10 to 90 %"):at_most "50 ms"
      ends(t, rise, 3.2, "rise")
      t:step "calm again"
      t:command { setpoint_rate = "50 Hz" }
      t:wait "200 ms"
      t:expect(t:value "i2c_refused", "orders without a good answer"):equal(0)
      t:expect(t:value "armed", "still armed"):equal(1)
    end,
  }
end

flood("1kHz", "1 kHz")
flood("10kHz", "10 kHz")
