-- The first flight: take off to 1.1 m, hover 20 s through a sideways gust, land, disarm
-- (include/judged_hover.lua). The ESCs hang on I2C.
include "include/judged_hover.lua"

plan "hover" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "quick", "flight" },
  timeout = "60 s",
  run = function(t)
    t:step "boot"
    t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
    t:wait "3 s" -- gyro bias on the ground, capture poses, ESC arming zeros

    judged_hover(t, function()
      for _, esc in ipairs { "esc1", "esc2", "esc3", "esc4" } do
        t:bus { device = esc, direction = "write", period = "20 ms", tolerance = "0.5 ms", during = "20 s" }
        t:bus { device = esc, direction = "read", period = "50 ms", tolerance = "1 ms", during = "20 s" }
      end
    end)
  end,
}
