-- The first flight: take off to 1.1 m, hover 20 s through a sideways gust, land, disarm
-- (include/judged_hover.lua). The ESCs hang on I2C.
include "include/judged_hover.lua"

local function flight(t, amps)
  t:step "boot"
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  t:wait "3 s" -- gyro bias on the ground, capture poses, ESC arming zeros

  judged_hover(t, function()
    for _, esc in ipairs { "esc1", "esc2", "esc3", "esc4" } do
      t:bus { device = esc, direction = "write", period = "20 ms", tolerance = "0.5 ms", during = "20 s" }
      t:bus { device = esc, direction = "read", period = "50 ms", tolerance = "1 ms", during = "20 s" }
    end
  end, nil, amps)
end

plan "hover" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "quick", "flight" },
  timeout = "60 s",
  run = function(t) flight(t) end,
}

-- The same of the drawing: motors and rotors alike, nothing off its nominal. What it takes of the pack is the physics'
-- own, and tighter than what copies scatter.
plan "hover_of_the_drawing" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad", vehicle_with = { tolerance = "none" },
  tags = { "flight" },
  timeout = "60 s",
  run = function(t) flight(t, { each = { "1.25 A", "1.45 A" }, all = { "5.25 A", "6.05 A" } }) end,
}
