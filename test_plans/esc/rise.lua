-- The real image on the virtual thrust stand: arms, starts, holds 2 N, rises to 3.2 N, stops.
include "include/rise.lua"

plan "thrust_rise" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", battery = "4s_2200" },
  tags = { "quick", "esc" },
  timeout = "20 s",
  run = function(t)
    rise(t)
  end
}

-- Of the drawing itself, for comparison.
plan "thrust_rise_of_the_drawing" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", battery = "4s_2200", tolerance = "none" },
  tags = { "esc" },
  timeout = "20 s",
  run = function(t)
    rise(t)
  end
}
