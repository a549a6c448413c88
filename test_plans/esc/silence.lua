-- No valid set-point any more: the motor is off within 0.6 s of the last one, and stays off.
include "include/silence.lua"

plan "silence" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", battery = "4s_2200" },
  tags = { "quick", "esc" },
  timeout = "20 s",
  run = function(t)
    fall_silent(t)
  end,
}
