-- What the plans without motion capture share.

wind = { wind_east = "3 m/s", turbulence = "3 m/s" } -- in the mean, and MIL-F-8785C of 3 m/s at 6 m

-- From power-up to armed: the receiver's cold start takes 29 s, and half a minute goes by until it states less
-- than 6 m; then the vehicle's frame begins with the mean of five seconds.
function arm_by_gps(t)
  t:within("90 s", function(s) return s.receiver_north_m == s.receiver_north_m end, "the origin of its frame is told")
  t:wait "4 s"
  t:command { arm = true }
  t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
end

-- To a steady hover 6 m above where it stood.
function hover_by_gps(t)
  arm_by_gps(t)
  t:command { takeoff = "6 m" }
  t:within("30 s", function(s) return s.told_height_m > 5.8 end, "6 m high")
  t:wait "10 s"
end
