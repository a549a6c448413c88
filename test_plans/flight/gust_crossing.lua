-- The gust crossing of the thesis (5.4.2, Fig 5.15): at 0.3 m/s and 1.1 m height through a round jet of some
-- 3.5 m/s and 0.35 m radius. Once through the middle, and back 20 cm beside it, where only one side of
-- the vehicle stands in the jet. Upwards as in the thesis, and downwards. How strong the jet is, where its
-- axis stands and where the way begins is drawn from the seed, as no crossing is flown twice;
--     whirl run test_plans/flight/gust_crossing.lua --seeds 2..21 --jobs 2
-- draws the heights of all over each other, as the figure has them.
--
-- Limits: under RPM control the thesis's vehicle departs up to about 0.1 m in height, and sideways by 0.3 m
-- (1 sigma) with its own position loop. By power (mode 5) it departs less there. Here the power of the rotor falls in
-- an upward flow as it does in a downward one, so that 3.5 m/s from below look like some 3 m/s from above. Before it
-- flies, each ESC of hp_quad_st is told what its own motor and propeller take in still air, and from 6.5 % less power on
-- it believes that the air comes from above. An updraft of 3.7 m/s does not reach that: the vehicle departs as
-- under RPM control, on 25 of 26 copies; one rises by 6 cm more (1.25 m is the limit). From above it loses as much as
-- under RPM control; of 26 copies one came higher than 1.4 m behind it, which a part of its ESCs had seen (1.45 m).
-- What 6.5 % and more are worth shows the downward jet of 5 m/s, where RPM control loses half of the height.
-- Downwards nothing of the thesis says how far. This rotor's inflow hardly changes in 3.5 m/s from below
-- (the vortex ring state), in 3.5 m/s from above by some 2 m/s, and with it the thrust by a third; earlier
-- this vehicle lost 31 cm in such a stream. 35 cm is the limit, 30 cm that it may rise above its height behind. In
-- 5 m/s it is what RPM control loses in 3.5 m/s; RPM control itself may lose twice that, and is
-- shoved on by 15 to 20 cm (26 copies; 25 cm is the limit, set after that).
include "include/hover.lua"

local signals = { "height", "east", "north", "tilt", "wind_down" }

local limits = {
  up = { highest = { "1.11 m", "1.2 m" }, lowest = { "1.0 m", "1.1 m" } },
  up_by_power = { highest = { "1.11 m", "1.25 m" }, lowest = { "1.0 m", "1.1 m" } },
  down_by_power = { highest = { "1.1 m", "1.45 m" }, lowest = { "0.74 m", "1.09 m" } },
  strong_by_power = { highest = { "1.1 m", "1.4 m" }, lowest = { "0.75 m", "1.09 m" } },
  down = { highest = { "1.1 m", "1.4 m" }, lowest = { "0.75 m", "1.09 m" } },
  strong = { highest = { "1.1 m", "1.6 m" }, lowest = { "0.4 m", "0.75 m" }, through_m = 0.25 },
}
local strengths = { up = { "3.3 m/s", "3.7 m/s" }, down = { "3.3 m/s", "3.7 m/s" }, strong = { "4.8 m/s", "5.2 m/s" } }

-- Flies to `north` at `east` through the jet, and judges the way.
local function cross(t, jet, allowed, name, north, east)
  local off_m = allowed.through_m or 0.1
  t:step(name)
  t:command { position = { east = east .. " m" }, speed = "0.3 m/s" }
  t:wait "4 s"
  local way = t:record(signals, "13 s", function()
    t:command { position = { north = north .. " m" }, speed = "0.3 m/s" }
  end)
  if jet == "up" then
    t:expect(way:min "wind_down", name .. ": upward flow met"):at_most "-3.2 m/s"
  else
    t:expect(way:max "wind_down", name .. ": downward flow met"):at_least "3.2 m/s"
  end
  t:expect(way:max "height", name .. ": highest"):within(allowed.highest[1], allowed.highest[2])
  t:expect(way:min "height", name .. ": lowest"):within(allowed.lowest[1], allowed.lowest[2])
  t:expect(way:max_error("east", east .. " m"), name .. ": sideways"):at_most "30 cm"
  t:expect(way:max "tilt", name .. ": tilt"):at_most "15 deg"
  t:expect(way:final "north", name .. ": is through"):within(north - off_m .. " m", north + off_m .. " m")
end

local function gust_crossing(name, jet, allowed, image, vehicle)
  plan(name) {
    image = image, board = "px4fmu_v1", vehicle = vehicle,
    tags = { "flight", "gust" }, timeout = "60 s",
    run = function(t)
      local strength = t:quantity(t:drawn(table.unpack(strengths[jet])))
      local from = t:quantity(t:drawn("1.3 m", "1.5 m")) -- as far back from the axis as the thesis's
      t:step "to the start"
      hover(t)
      t:command { position = { north = from .. " m" }, speed = "0.5 m/s" }
      t:wait "7 s"
      t:gust { jet = { up = (jet == "up" and strength or -strength) .. " m/s", radius = "35 cm",
                       north = t:drawn("-5 cm", "5 cm"), east = t:drawn("-5 cm", "5 cm") } }
      cross(t, jet, allowed, "through the middle", -1.5, 0)
      cross(t, jet, allowed, "beside it", 1.5, 0.2)
    end,
  }
end

for _, jet in ipairs { "up", "down", "strong" } do
  local suffix = ({ up = "", down = "_down", strong = "_strong" })[jet]
  gust_crossing("gust_crossing" .. suffix, jet, limits[jet], "flight", "hp_quad")
  gust_crossing("gust_crossing_by_power" .. suffix, jet, limits[jet .. "_by_power"], "flight_st", "hp_quad_st")
end
