-- What the plans share in which a GPS receiver fails; with include/gps.lua and include/moment.lua.
include "include/fail_safe.lua"

-- Blind it comes down in some 20 s, and the wind carries it meanwhile: 3 m/s for so long, at most.
function gps_fault_plan(board, name, run)
  plan(name) {
    image = "flight", board = board, vehicle = "hp_quad",
    tags = { "flight", "faults" }, timeout = "240 s",
    outdoors = true, air = wind, fence = { radius = "70 m", height = "20 m" },
    run = run,
  }
end

-- Where the vehicle is from now on, against where it was.
function stays_near(t, limit, duration)
  local north, east = t:value("north", "m"), t:value("east", "m")
  local r = t:record({ "north", "east" }, duration)
  t:expect(r:max_error { north = string.format("%.3f m", north), east = string.format("%.3f m", east) }, "farthest from where it was"):at_most(limit)
end

-- What is wrong with the solutions is noticed before it has been followed.
function noticed(t, fault)
  hover_by_gps(t)
  some_moment(t)
  t:fault(fault)
  stays_near(t, "3 m", "2 s")
  comes_down(t)
end

-- It begins anew at 9600 baud with NMEA at 1 Hz: the driver finds it, sets it up, and the estimate has it back.
function found_again_in_flight(t, brown_out)
  hover_by_gps(t)
  some_moment(t)
  t:fault(brown_out)
  comes_down(t)
  t:wait "20 s"
  t:command { arm = true }
  t:within("10 s", function(s) return s.told_armed == 1 end, "armed anew by the receiver that was found")
end

-- It flies on, and once its settings are polled and told again, solutions come five times a second as before.
function forgets_in_flight(t, forgets)
  hover_by_gps(t)
  some_moment(t)
  t:expect(t:value "gps_period", "between solutions, before"):within("199 ms", "201 ms")
  t:fault(forgets)
  t:within("3 s", function(s) return s.gps_period_s > 0.9 end, "solutions come once a second")
  t:within("13 s", function(s) return s.gps_period_s < 0.3 end, "and five times a second again")
  local r = t:record({ "gps_period", "told_state" }, "5 s")
  t:expect(r:max "gps_period", "between solutions, at most"):at_most "201 ms"
  t:expect(r:max "told_state", "it flies on"):at_most(2)
end

-- Blind, by vertical speed alone: the wind may lay it on its side when it touches the ground.
function comes_down(t)
  lands(t, "no position", 4, { noticed = "3 s", tilt = "30 deg", down = "40 s", upright = false })
end
