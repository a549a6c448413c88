-- Outdoors without motion capture, in the wind: GPS holds the place, the barometer the height, the magnetic field
-- the heading. A receiver is metres off, and its error wanders: the vehicle is held to where its receiver sees it
-- (receiver_north, receiver_east); how far that is from the truth is told beside it.
include "include/calibration.lua"
include "include/gps.lua"
include "include/judged_gps.lua"
include "include/parameter.lua"

plan "gps" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "300 s",
  outdoors = true, air = wind, fence = { radius = "40 m", height = "20 m" },
  run = function(t)
    t:step "cold start"
    arm_by_gps(t)
    t:budget("cpu") { busy = "60 %", margin = "10 %" }
    t:budget("fw::imu_task") { period = "1 ms", jitter = "20 us", margin = "10 %" }
    t:budget("fw::attitude_task") { execution = "300 us", response = "500 us", margin = "10 %" }
    t:budget("fw::gps_task") { execution = "200 us", response = "500 us", margin = "10 %" }
    judged_gps(t)
  end,
}

plan "gps: the same hover on motion capture" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "120 s",
  room = { size = { "40 m", "40 m", "20 m" } }, air = wind,
  run = function(t)
    t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
    set_parameter(t, "FENCE_TOP", 20)
    t:wait "3 s"
    t:command { arm = true }
    t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
    t:command { takeoff = "6 m" }
    t:within("30 s", function(s) return s.told_height_m > 5.8 end, "6 m high")
    t:wait "10 s"
    local hover = t:record({ "north", "east", "height", "attitude_error" }, "60 s")
    t:expect(hover:rms_error { north = "0 m", east = "0 m" }, "hover: RMS distance in truth"):at_most "10 cm"
    t:expect(hover:rms_error("height", "6 m"), "hover: height RMS error"):at_most "10 cm"
    t:expect(hover:rms "attitude_error", "hover: RMS error of attitude"):at_most "3 deg"
  end,
}

-- What six sides leave of the zero points is 0.04 m/s2. They tell nothing of how axes lean: 0.67 % of one in another is
-- 0.065 m/s2 of gravity, a board that sits 0.3 degrees askew 0.051. Together 0.092 (1 sigma), 0.54 degrees about each level
-- axis, and across a field that dips by 66 degrees 1.2 of heading: 1.44, three times 4.3. What gusts leave in the filters and
-- the motors' fields turn the heading by another 0.3.
plan "gps: with its accelerometer calibrated" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "240 s",
  outdoors = true, air = wind, fence = { radius = "40 m", height = "20 m" },
  run = function(t)
    calibrate_accelerometer(t)
    t:step "hover"
    hover_by_gps(t)
    local hover = t:record({ "attitude_error", "heading_error", "receiver_north", "receiver_east" }, "40 s")
    t:expect(hover:rms "attitude_error", "hover: RMS error of attitude"):at_most "4.3 deg"
    t:expect(hover:mean "heading_error", "hover: mean error of heading"):within("-4 deg", "4 deg")
  end,
}
