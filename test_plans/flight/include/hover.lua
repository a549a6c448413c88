-- What the flight plans share.

-- From the first heartbeat to a steady hover at 1.1 m above where the vehicle stood.
function hover(t)
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  t:wait "3 s" -- gyro bias on the ground, capture poses, ESC arming zeros
  t:command { arm = true }
  t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
  t:command { takeoff = "1.1 m" }
  t:within("6 s", function(s) return s.height_m > 1.0 end, "1 m high")
  t:wait "3 s"
end
