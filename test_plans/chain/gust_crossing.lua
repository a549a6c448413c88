-- The thesis's gust crossing, by the limits of test_plans/flight/gust_crossing.lua, with the ESCs' controllers of speed in
-- their own images: at 0.3 m/s through a jet from below, and through one from above.
include "include/chain.lua"
include "include/flights.lua"

local limits = {
  up = { highest = { "1.11 m", "1.2 m" }, lowest = { "1.0 m", "1.1 m" } },
  down = { highest = { "1.1 m", "1.4 m" }, lowest = { "0.75 m", "1.09 m" } },
}

local function crosses(t, jet)
  t:step "through the middle"
  t:command { position = { east = "0 m" }, speed = "0.3 m/s" }
  t:wait "4 s"
  local way = t:record({ "height", "east", "north", "tilt", "wind_down" }, "13 s", function()
    t:command { position = { north = "-1.5 m" }, speed = "0.3 m/s" }
  end)
  if jet == "up" then
    t:expect(way:min "wind_down", "upward flow met"):at_most "-3.2 m/s"
  else
    t:expect(way:max "wind_down", "downward flow met"):at_least "3.2 m/s"
  end
  t:expect(way:max "height", "highest"):within(limits[jet].highest[1], limits[jet].highest[2])
  t:expect(way:min "height", "lowest"):within(limits[jet].lowest[1], limits[jet].lowest[2])
  t:expect(way:max_error("east", "0 m"), "sideways"):at_most "30 cm"
  t:expect(way:max "tilt", "tilt"):at_most "15 deg"
  t:expect(way:final "north", "is through"):within("-1.6 m", "-1.4 m")
end

for _, jet in ipairs { "up", "down" } do
  chain_plan("chain gust crossing " .. jet, { timeout = "60 s", parity = true }, function(t)
    local strength = t:quantity(t:drawn("3.3 m/s", "3.7 m/s"))
    local from = t:quantity(t:drawn("1.3 m", "1.5 m"))
    t:step "to the start"
    hovers(t)
    t:command { position = { north = from .. " m" }, speed = "0.5 m/s" }
    t:wait "7 s"
    t:gust { jet = { up = (jet == "up" and strength or -strength) .. " m/s", radius = "35 cm",
                     north = t:drawn("-5 cm", "5 cm"), east = t:drawn("-5 cm", "5 cm") } }
    crosses(t, jet)
  end)
end
