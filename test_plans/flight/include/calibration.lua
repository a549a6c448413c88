-- Calibrations as somebody does them, with the vehicle in the hand.

-- Asks for one, and expects that it is taken up: MAV_RESULT 5, in progress.
function begin_calibration(t, what)
  t:command { calibrate = what }
  t:within("3 s", function(s) return s.calibration_result == 5 end, what .. ": begins")
end

-- Expects how it ends: MAV_RESULT 0 accepted, 4 failed, 6 cancelled.
function end_calibration(t, what, within, result)
  t:within(within, function(s) return s.calibration_result ~= 5 end, what .. ": ends")
  t:expect(t:value "calibration_result", what .. ": result"):equal(result)
end

-- The value that a parameter has.
function parameter(t, name)
  t:command { parameter = { name = name } }
  t:within("5 s", function(s) return s.parameter_pending == 0 end, name .. ": answered")
  return t:value "parameter_value".value
end

-- Roll and pitch in degrees that have each face up, upright first.
six_sides = { { 0, 0 }, { 90, 0 }, { -90, 0 }, { 180, 0 }, { 0, 90 }, { 0, -90 } }

-- Held still for 3 s on each of the first `sides` of them.
function show_sides(t, sides)
  for i = 1, sides do
    local side = six_sides[i]
    t:hold { roll = side[1] .. " deg", pitch = side[2] .. " deg", over = "1.5 s" }
    t:wait "4.5 s"
  end
end

-- From power-up: the accelerometer's six sides, and down again with that heading (north, where nothing is said).
function calibrate_accelerometer(t, yaw)
  t:step "six sides"
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  t:wait "3 s"
  begin_calibration(t, "accelerometer")
  show_sides(t, 6)
  end_calibration(t, "accelerometer", "3 s", 0)
  if yaw then
    t:hold { yaw = yaw, over = "2 s" }
    t:wait "2 s"
  end
  put_down(t)
end

-- From meridian to meridian, 30 degrees apart, nose up on one and down on the next.
function turn_round(t, first_deg, last_deg)
  local pitch = -80
  for roll = first_deg, last_deg, 30 do
    t:hold { roll = roll .. " deg", pitch = pitch .. " deg", over = "1 s" }
    t:wait "1 s"
    pitch = -pitch
    t:hold { roll = roll .. " deg", pitch = pitch .. " deg", over = "2.5 s" }
    t:wait "2.5 s"
  end
end

function put_down(t)
  t:release { over = "2 s" }
  t:wait "3 s"
end
