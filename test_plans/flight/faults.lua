-- One plan per class of fault, each in a hover at a moment that the seed draws: what the flight image does about it.
-- What ends the flight ends as include/fail_safe.lua says.
include "include/fail_safe.lua"
include "include/hover.lua"
include "include/moment.lua"

-- The set-points of these ESCs stay on time whatever happens to the others.
local function on_time(t, escs)
  for _, esc in ipairs(escs) do
    t:bus { device = esc, direction = "write", period = "20 ms", tolerance = "0.5 ms", nacks = 0,
            during = "1 s" }
  end
end

-- Flies on as if nothing had been, and lands by command.
local function flies_on(t)
  local after = t:record({ "height", "offset", "tilt" }, "3 s")
  t:expect(after:rms_error("height", "1.1 m"), "after: height RMS error"):at_most "5 cm"
  t:expect(after:rms_error("offset", "0 m"), "after: sideways RMS error"):at_most "10 cm"
  t:command { land = true }
  t:within("10 s", function(s) return s.told_armed == 0 end, "landed and disarmed")
end

local function flight_plan(name, run)
  plan(name) {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
    tags = { "quick", "flight", "faults" }, timeout = "90 s",
    run = run,
  }
end

flight_plan("an ESC that refuses for 100 ms is tried again and flown on", function(t)
  hover(t)
  some_moment(t)
  on_time(t, { "esc1", "esc3", "esc4" })
  t:fault { kind = "i2c_nack", device = "esc2", duration = "100 ms" }
  t:wait "500 ms"
  flies_on(t)
end)

-- It is silent after half a second without an answer.
flight_plan("an ESC that refuses for ever ends the flight within 600 ms", function(t)
  hover(t)
  some_moment(t)
  t:fault { kind = "i2c_nack", device = "esc2" }
  cuts(t, "an ESC is silent", { noticed = "500 ms", driven = 2 })
end)

flight_plan("SDA stuck until nine clocks is freed by the image", function(t)
  hover(t)
  some_moment(t)
  on_time(t, { "esc1", "esc2", "esc3", "esc4" })
  t:fault { kind = "i2c_stuck_sda", bus = "i2c3", duration = "400 ms", value = 9 }
  t:wait "500 ms"
  flies_on(t)
end)

flight_plan("a frozen IMU stops the motors", function(t)
  hover(t)
  some_moment(t)
  t:fault { kind = "sensor_frozen", device = "imu" }
  cuts(t, "IMU samples are frozen") -- fifty that are the same: half of the 100 ms
end)

flight_plan("a lost capture makes the image land by itself", function(t)
  hover(t)
  some_moment(t)
  t:fault { kind = "capture_lost" }
  lands(t, "no position", 4, { noticed = "2 s", tilt = "10 deg", down = "12 s" })
end)

flight_plan("a radio that falls silent makes the image land by itself", function(t)
  hover(t)
  some_moment(t)
  t:fault { kind = "uart_silence", device = "radio" }
  lands(t, "no position", 4, { noticed = "2 s", down = "12 s" })
end)

flight_plan("a rate at its rail for 10 ms is not believed", function(t)
  hover(t)
  some_moment(t)
  t:fault { kind = "sensor_saturated", device = "imu", axis = "gyro_x", duration = "10 ms" }
  t:wait "500 ms"
  flies_on(t)
end)

-- It is believed, unlike a rate: ten samples of 78 m/s2 are 0.8 m/s that the fixes take back within half a second.
flight_plan("an acceleration at its rail for 10 ms is flown through", function(t)
  hover(t)
  some_moment(t)
  t:fault { kind = "sensor_saturated", device = "imu", axis = "accel_x", duration = "10 ms" }
  local off = t:record({ "offset", "tilt" }, "2 s")
  t:expect(off:max "offset", "carried off"):at_most "50 cm"
  t:expect(off:max "tilt", "tilt"):at_most "20 deg"
  t:wait "3 s"
  flies_on(t)
end)

flight_plan("an IMU that leaves the bus stops the motors", function(t)
  hover(t)
  some_moment(t)
  t:fault { kind = "spi_silent", device = "imu" }
  cuts(t, "IMU gives no samples")
end)

-- 2048 of a rate's counts in twenty samples: 62 degrees per second that are not there.
flight_plan("a bit of the IMU's wire that is flipped for 20 ms is flown through", function(t)
  hover(t)
  some_moment(t)
  t:fault { kind = "spi_flip", device = "imu", duration = "20 ms", value = 8 * 9 + 3 }
  t:wait "500 ms"
  flies_on(t)
end)

-- The wire repeats what it last carried. Five samples are no sign of anything; for good, the IMU is lost.
flight_plan("an IMU's wire that stands still for 5 ms is flown through", function(t)
  hover(t)
  some_moment(t)
  t:fault { kind = "spi_frozen", device = "imu", duration = "5 ms" }
  t:wait "500 ms"
  flies_on(t)
end)

flight_plan("an IMU's wire that stands still for good stops the motors", function(t)
  hover(t)
  some_moment(t)
  t:fault { kind = "spi_frozen", device = "imu" }
  cuts(t, "IMU gives no samples") -- its settings read back as the samples that the wire repeats: no driver believes that part
end)

-- It sleeps until the image has set it up anew: longer than attitude can be held without it.
flight_plan("an IMU whose supply fails for 5 ms stops the motors, and is set up anew", function(t)
  hover(t)
  some_moment(t)
  t:fault { kind = "sensor_brown_out", device = "imu", duration = "5 ms" }
  cuts(t, "IMU gives no samples")
  -- It has tumbled: its two filters agree again once they have converged, for which they have 25 s. On its side it may not arm.
  t:wait "25 s"
  t:command { arm = true }
  if t:value("tilt").value < math.rad(20) then
    t:within("2 s", function(s) return s.told_armed == 1 end, "armed again")
  else
    t:told("2 s", "not level")
    t:expect(t:value "told_armed", "armed, lying on its side"):equal(0)
  end
end)

flight_plan("an IMU of another make is never armed", function(t)
  t:fault { kind = "sensor_wrong_identity", device = "imu", value = 0x70 }
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  t:wait "3 s"
  local armed = t:always("told_armed")
  armed:at_most(0)
  t:command { arm = true }
  t:within("2 s", function(s) return s.command_result == 1 end, "refused for the time being")
  t:wait "2 s"
  armed:stop()
end)

for _, f in ipairs {
  { is = "lost", kind = "uart_loss", device = "radio" }, { is = "with a flipped bit", kind = "uart_flip", device = "radio" },
} do
  flight_plan("one radio byte in a hundred " .. f.is .. " is flown through", function(t)
    hover(t)
    some_moment(t)
    t:fault { kind = f.kind, device = f.device, duration = "1 s", value = 0.01 }
    t:wait "1 s"
    flies_on(t)
  end)
end
