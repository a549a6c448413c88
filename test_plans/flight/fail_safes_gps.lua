-- The fail-safes of fail_safes.lua outdoors, without motion capture, 6 m up in the wind: GPS holds the place, so that what comes
-- down under control does so where it was. Each at a moment that the seed draws; each ends as include/fail_safe.lua says, within
-- the fence that the image keeps by GPS (40 m). What a receiver's own faults do is in faults_gps.lua.
include "include/fail_safe.lua"
include "include/gps.lua"
include "include/moment.lua"

local function fail_safe(name, run)
  plan("gps: " .. name) {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
    tags = { "flight", "fail_safe" }, timeout = "240 s",
    outdoors = true, air = wind, fence = { radius = "40 m", height = "20 m" },
    run = function(t)
      hover_by_gps(t)
      some_moment(t)
      run(t)
    end,
  }
end

-- Against 3 m/s and gusts it leans by up to 25 degrees in a hover (include/judged_gps.lua).
local function lands_there(t, words, state) lands(t, words, state, { tilt = "30 deg", down = "40 s" }) end

fail_safe("the battery is empty", function(t)
  t:fault { kind = "supply_dip", value = "3.4 V" }
  lands_there(t, "battery empty", 4)
end)

-- Nothing from the ground for 3 s; what it tells goes on.
fail_safe("the radio link is lost", function(t)
  t:fault { kind = "uart_silence", device = "radio" }
  lands_there(t, "radio link lost", 3)
end)

-- It is silent after half a second, for which its ESC turns on by itself as well.
fail_safe("an ESC falls silent", function(t)
  t:fault { kind = "i2c_nack", device = "esc3" }
  cuts(t, "an ESC is silent", { noticed = "500 ms", driven = 3 })
end)

fail_safe("the IMU leaves its bus", function(t)
  t:fault { kind = "spi_silent", device = "imu" }
  cuts(t, "IMU gives no samples")
end)

fail_safe("a motor stops", function(t)
  t:fault { kind = "esc_stopped", motor = 2 }
  cuts(t, "a motor has stopped", { driven = 2 })
end)

-- Without it the vehicle may go on for as long as it holds its place by its receiver within 1 m, its height within 1 m and its
-- heading within 10 degrees; or it lands. Half a minute of that is judged, and the way down in any case.
local function flies_on_or_lands(t, words)
  local yaw, height = string.format("%.3f deg", t:value("yaw", "deg")), string.format("%.3f m", t:value("height", "m"))
  t:always("climb"):at_least "-2 m/s"
  t:always("inside_fence"):at_least(1)
  t:told("3 s", words)
  local r = t:record({ "receiver_north", "receiver_east", "height", "yaw", "told_state" }, "30 s")
  if r:max("told_state").value <= 2 then
    t:expect(r:rms_error { receiver_north = "0 m", receiver_east = "0 m" }, "flown on: RMS distance, by its receiver"):at_most "1 m"
    t:expect(r:rms_error("height", height), "flown on: height RMS error from what it was"):at_most "1 m"
    t:expect(r:max_error("yaw", yaw), "flown on: heading from what it was"):at_most "10 deg"
    t:command { land = true }
  else
    t:expect(r:max "told_state", "it lands by itself: told_state"):within(3, 4)
  end
  t:within("40 s", function(s) return s.on_ground == 1 end, "touches the ground")
  ends_on_the_ground(t, {})
end

for _, f in ipairs { { "baro", "barometer" }, { "mag", "magnetometer" } } do
  fail_safe("the " .. f[2] .. " falls silent", function(t)
    t:fault { kind = "i2c_nack", device = f[1] }
    flies_on_or_lands(t, f[2] .. " silent")
  end)
end
