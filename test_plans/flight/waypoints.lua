-- State 8 of the ground station: waypoints from a file (thesis, table 3.9). Straight from one to the next at 0.5 m/s,
-- each held as the file says. The path is 0.8 + 0.8 + 1.676 + 1.6 + 1.676 + 1.131 = 7.68 m, thus 15.4 s, and 5 s are held:
-- with up to 1.5 s at each of the six for the vehicle to arrive behind its command, 29.4 s at most. It may lag behind the
-- moving place by what 0.5 m/s are in the second that a step takes (thesis, table 6.1). Heading is not what this is
-- about: its loop swings over by a tenth of a turn, and takes seconds to come back.
include "include/hover.lua"

plan "waypoints" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "90 s",
  run = function(t)
    hover(t)
    local places = {
      { "0.8 m", "0 m", "1.1 m" }, { "0.8 m", "0.8 m", "1.1 m" }, { "-0.8 m", "0.8 m", "1.6 m" },
      { "-0.8 m", "-0.8 m", "1.6 m" }, { "0.8 m", "-0.8 m", "1.1 m" }, { "0 m", "0 m", "1.1 m" },
    }
    t:step "waypoints"
    t:always("path_error"):at_most "50 cm"
    t:command { waypoints = "waypoints/room.txt" }
    local begin_s = t:now().value
    for number, place in ipairs(places) do
      t:within("10 s", function(s) return s.waypoint == number end, "waypoint " .. number .. " is reached")
      for i, signal in ipairs { "north", "east", "height" } do
        local want = t:quantity(place[i])
        t:expect(t:value(signal), signal .. " at waypoint " .. number):within(
          string.format("%.2f m", want - 0.1), string.format("%.2f m", want + 0.1))
      end
    end
    t:expect(t:now().value - begin_s, "time of the path in s"):within("20.4", "29.4")
    t:expect(t:value("yaw", "deg"), "heading at the end in deg"):within("-20", "20")
    t:command { land = true }
    t:within("15 s", function(s) return s.told_armed == 0 end, "landed")
  end,
}
