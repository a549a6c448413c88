-- What the flight plans share.

-- From the first heartbeat to a steady hover at 1.1 m above where the vehicle stood.
function hover(t)
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  t:wait "3 s" -- gyro bias on the ground, capture poses, ESC arming zeros
  take_off(t)
end

-- Of who is ready: to the same.
function take_off(t)
  t:command { arm = true }
  t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
  t:command { takeoff = "1.1 m" }
  t:within("6 s", function(s) return s.height_m > 1.0 end, "1 m high")
  t:wait "3 s"
end

-- From there a step of the commanded position.
function judged_step(t)
  t:step "1 m north"
  local r = t:record({ "north", "height", "tilt" }, "6 s", function()
    t:command { position = { north = "1 m" } }
  end)
  t:expect(r:rise_time "north", "rise, 10 to 90 %"):at_most "1 s"
  t:expect(r:response_time "north", "command on the wire to 90 %"):at_most "1.6 s"
  t:expect(r:overshoot "north", "overshoot"):at_most "10 %"
  t:expect(r:rms_error("height", "1.1 m"), "height RMS error"):at_most "5 cm"
  t:expect(r:max "tilt", "tilt"):at_most "20 deg"
  t:expect(r:final "north", "arrives"):within("0.95 m", "1.05 m")
end
