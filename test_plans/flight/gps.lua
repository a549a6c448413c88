-- Outdoors without motion capture, in the wind: GPS holds the place, the barometer the height, the magnetic field
-- the heading. A receiver is metres off, and its error wanders: the vehicle is held to where its receiver sees it
-- (receiver_north, receiver_east); how far that is from the truth is told beside it.
include "include/calibration.lua"
include "include/gps.lua"
include "include/parameter.lua"

plan "gps" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "300 s",
  outdoors = true, air = wind, fence = { radius = "40 m", height = "20 m" },
  run = function(t)
    t:step "cold start"
    arm_by_gps(t)
    t:budget("cpu") { busy = "60 %" }
    t:budget("fw::imu_task") { period = "1 ms", jitter = "20 us" }
    t:budget("fw::attitude_task") { execution = "300 us", response = "500 us" }
    t:budget("fw::gps_task") { execution = "200 us", response = "500 us" }
    t:always("inside_fence"):at_least(1)

    t:step "take-off"
    t:command { takeoff = "6 m" }
    t:within("30 s", function(s) return s.told_height_m > 5.8 end, "6 m high")
    t:wait "10 s"

    t:wait "20 s" -- the receiver settles with 15 s

    t:step "hover"
    local hover = t:record({ "receiver_north", "receiver_east", "north", "east", "height", "told_height", "attitude_error", "velocity_error_north",
                             "velocity_error_east", "velocity_error_down", "tilt" }, "60 s")
    t:expect(hover:rms_error { receiver_north = "0 m", receiver_east = "0 m" }, "hover: RMS distance, by its receiver"):at_most "0.5 m"
    -- Two errors of 2.1 m per axis, the origin's and the present one, three times.
    t:expect(hover:rms_error { north = "0 m", east = "0 m" }, "hover: RMS distance in truth"):at_most "9 m"
    -- What it makes of its barometer, it holds. The rotors' wash, which only capture would tell, is 4 Pa of 0.1 of
    -- their disc load; the air wanders by 5 Pa (1 sigma) in three minutes: 0.36 m, and three times 0.44 m.
    t:expect(hover:rms_error("told_height", "6 m"), "hover: height RMS error, by its own estimate"):at_most "0.3 m"
    t:expect(hover:rms_error("height", "6.1 m"), "hover: height RMS error in truth"):at_most "1.7 m"
    t:expect(hover:rms_error { velocity_error_north = "0 m/s", velocity_error_east = "0 m/s" }, "hover: RMS error of velocity over ground"):at_most "0.4 m/s"
    t:expect(hover:rms "velocity_error_down", "hover: RMS error of its climb"):at_most "0.2 m/s"
    -- Not calibrated: 0.15 m/s2 of zero point (1 sigma) is 0.9 degrees about each axis, and across a field that dips by
    -- 66 degrees turns the heading by 2.0: together 2.4, three times.
    t:expect(hover:rms "attitude_error", "hover: RMS error of attitude"):at_most "7.1 deg"
    t:expect(hover:max "tilt", "hover: tilt"):at_most "25 deg"

    t:step "10 m away and back"
    t:command { position = { north = "10 m" } }
    t:within("20 s", function(s) return math.abs(s.receiver_north_m - 10) < 1 end, "there, by its receiver")
    t:wait "5 s"
    local away = t:record({ "receiver_north", "receiver_east" }, "20 s")
    -- A third of the time: it scatters more.
    t:expect(away:rms_error { receiver_north = "10 m", receiver_east = "0 m" }, "away: RMS distance, by its receiver"):at_most "0.7 m"
    t:command { position = { north = "0 m" } }
    t:within("20 s", function(s) return math.abs(s.receiver_north_m) < 1 end, "back, by its receiver")
    t:wait "5 s"

    t:step "land"
    t:command { land = true }
    t:within("40 s", function(s) return s.on_ground == 1 end, "on the ground")
    t:within("8 s", function(s) return s.told_armed == 0 end, "disarmed")
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

-- What its calibration leaves of the zero points is a quarter: 0.04 m/s2. With what gusts leave in the filters, and
-- the motors' fields, 2 degrees.
plan "gps: with its accelerometer calibrated" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "240 s",
  outdoors = true, air = wind, fence = { radius = "40 m", height = "20 m" },
  run = function(t)
    t:step "six sides"
    t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
    t:wait "3 s"
    begin_calibration(t, "accelerometer")
    show_sides(t, 6)
    end_calibration(t, "accelerometer", "3 s", 0)
    put_down(t)
    t:step "hover"
    hover_by_gps(t)
    local hover = t:record({ "attitude_error", "heading_error", "receiver_north", "receiver_east" }, "40 s")
    t:expect(hover:rms "attitude_error", "hover: RMS error of attitude"):at_most "2 deg"
    t:expect(hover:mean "heading_error", "hover: mean error of heading"):within("-2 deg", "2 deg")
  end,
}
