-- Armed, held by its receiver in the wind: 6 m up, a hover of a minute, 10 m away and back, down again. The same
-- limits wherever the receiver hangs.
function judged_gps(t)
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
  -- Not calibrated: 0.196 m/s2 of zero point, 0.065 of axes that lean and 0.051 of a board askew make 0.21 (1 sigma), 1.24
  -- degrees about each level axis, and across a field that dips by 66 degrees 2.8 of heading: together 3.3, three times.
  t:expect(hover:rms "attitude_error", "hover: RMS error of attitude"):at_most "10 deg"
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
end
