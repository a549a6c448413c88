-- Flights that touch what stands there: a landing on a slope, a wall, a ceiling; and one with a load on a line.
include "include/hover.lua"
include "include/parameter.lua"

local function flight(name, more, run)
  plan(name) {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
    tags = { "flight" }, timeout = "90 s",
    room = { size = { "6 m", "6 m", "3 m" } }, obstacles = more.obstacles, load = more.load,
    run = run,
  }
end

local function stands_still(t, tilt)
  local r = t:record({ "north", "east", "tilt" }, "3 s")
  t:expect(math.max(r:max("north").value - r:min("north").value, r:max("east").value - r:min("east").value),
           "slides by, m"):at_most(0.01)
  t:expect(r:max "tilt", "tilt on the slope"):at_most(tilt)
  for motor = 1, 4 do t:expect(t:value("speed_" .. motor), "speed of rotor " .. motor):at_most "5 rad/s" end
end

-- Feet on the uphill side touch first; the rotors let go by and by, and hold the place until then.
local function lands_on(t, angle)
  hover(t)
  t:command { position = { north = "2 m", height = "1.3 m" } }
  t:within("8 s", function(s) return s.north_m > 1.97 and math.abs(s.climb_mps) < 0.1 end, "over the slope")
  t:wait "2 s"
  t:step "land"
  local tilt = t:always("tilt")
  tilt:at_most(string.format("%d deg", angle + 5))
  t:command { land = true }
  t:within("12 s", function(s) return s.on_ground == 1 end, "on the slope")
  t:within("5 s", function(s) return s.told_armed == 0 end, "disarmed")
  t:told("2 s", "landed")
  t:wait "1 s" -- the rotors run out
  stands_still(t, string.format("%.1f deg", angle + 0.5))
  tilt:stop()
end

local function takes_off_again(t)
  t:step "off it again"
  t:within("2 s", function(s) return s.told_armed == 1 end, "armed on the slope")
  t:wait "1.5 s"
  local r = t:record({ "offset", "tilt" }, "6 s", function() t:command { takeoff = "1.3 m" } end)
  t:expect(r:max "tilt", "off the slope: tilt"):at_most "25 deg"
  t:expect(r:final "offset", "off the slope: distance from its target"):at_most "15 cm"
  t:expect(t:value "height", "off the slope: height"):at_least "1 m"
end

flight("lands on a slope of 10 degrees", { obstacles = { { kind = "slope", north = "1 m", towards = "0 deg", angle = "10 deg" } } }, function(t)
  lands_on(t, 10)
  -- The check for level is at 9.9 degrees of its own estimate: which side of it this is, its errors decide.
  t:command { arm = true }
  t:within("2 s", function(s) return s.command_result >= 0 end, "arming is answered")
  if t:value "command_result" == 0 then return takes_off_again(t) end
  t:told("2 s", "not level")
end)

flight("lands on a slope of 7 degrees and takes off again", { obstacles = { { kind = "slope", north = "1 m", towards = "0 deg", angle = "7 deg" } } }, function(t)
  lands_on(t, 7)
  t:command { arm = true }
  takes_off_again(t)
end)

flight("does not arm on a slope of 14 degrees", { obstacles = { { kind = "slope", north = "1 m", towards = "0 deg", angle = "14 deg" } } }, function(t)
  lands_on(t, 14)
  local armed = t:always("told_armed")
  armed:at_most(0)
  t:command { arm = true }
  t:told("2 s", "not level")
  armed:stop()
end)

-- A propeller is the first to touch. It stops, and three are no flight: a fail-safe.
flight("touches a wall", { obstacles = { { kind = "wall", distance = "2 m", towards = "0 deg" } } }, function(t)
  hover(t)
  t:step "to the wall"
  t:command { position = { north = "2.03 m" }, speed = "0.2 m/s" }
  t:within("12 s", function(s) return s.speed_1_radps == 0 end, "the front propeller strikes the wall")
  t:step "struck"
  t:told("2 s", "a motor has stopped")
  local currents = { "winding_current_1", "winding_current_2", "winding_current_3", "winding_current_4" }
  local after = t:record(currents, "1 s")
  for _, current in ipairs(currents) do t:expect(after:final(current), current .. " then"):at_most "0.5 A" end
  t:within("5 s", function(s) return s.told_armed == 0 and s.on_ground == 1 end, "on the floor, disarmed")
  t:expect(t:value "north", "on this side of the wall"):at_most "2 m"
end)

-- Hubs are what touches: they stand above the propellers' discs.
flight("bumps a ceiling", { obstacles = { { kind = "ceiling", height = "1.8 m" } } }, function(t)
  hover(t)
  t:step "to the ceiling"
  t:command { position = { height = "1.83 m" }, speed = "0.2 m/s" }
  t:within("10 s", function(s) return s.touching == 1 end, "touches the ceiling")
  local r = t:record({ "tilt", "offset", "height" }, "4 s")
  t:expect(r:max "tilt", "at the ceiling: tilt"):at_most "15 deg"
  t:expect(r:max "height", "at the ceiling: height"):at_most "1.8 m"
  t:step "down again"
  t:command { position = { height = "1.1 m" } }
  t:wait "4 s"
  local hover = t:record({ "height", "offset" }, "3 s")
  t:expect(hover:rms_error("height", "1.1 m"), "hover: height RMS error"):at_most "5 cm"
  t:expect(t:value "told_state", "still flying"):equal(2)
end)

-- A pendulum of 0.5 m swings with 1.4 s: within the bandwidth of the place's control, which must not drive it.
flight("a load on a line", { load = { mass = "150 g", line = "0.5 m" } }, function(t)
  hover(t)
  t:command { position = { height = "1.5 m" } }
  t:wait "6 s"
  local function swing_m(s)
    local north, east = s.load_north_m - s.north_m, s.load_east_m - s.east_m
    return math.sqrt(north * north + east * east)
  end
  t:step "hover with it"
  local calm = t:always("hover: the load swings by less than 10 cm", function(s) return swing_m(s) < 0.1 end)
  local hover = t:record({ "height", "offset", "line_tension" }, "8 s")
  calm:stop()
  t:expect(hover:rms_error("height", "1.5 m"), "hover: height RMS error"):at_most "5 cm"
  t:expect(hover:rms "offset", "hover: sideways RMS error"):at_most "10 cm"
  t:expect(hover:mean "line_tension", "hover: the line carries its weight"):within("1.44 N", "1.50 N")
  t:step "a metre aside"
  -- The reference's 1.5 m/s2 hold it back by 9 degrees; begun and ended at once that swings to twice as much each time.
  local bounded = t:always("step: the load swings by less than 35 degrees", function(s) return swing_m(s) < 0.287 end)
  t:command { position = { north = "1 m" } }
  t:within("3 s", function(s) return swing_m(s) > 0.05 end, "it swings")
  t:wait "7 s"
  bounded:stop()
  local still = t:always("8 s later: by less than 10 cm", function(s) return swing_m(s) < 0.1 end)
  local there = t:record({ "offset", "tilt" }, "4 s")
  still:stop()
  t:expect(there:rms "offset", "there: sideways RMS error"):at_most "10 cm"
  t:command { position = { north = "0 m" } }
  t:wait "8 s"
  t:command { land = true }
  t:within("12 s", function(s) return s.on_ground == 1 end, "on the ground")
  t:within("6 s", function(s) return s.told_armed == 0 end, "disarmed")
end)
