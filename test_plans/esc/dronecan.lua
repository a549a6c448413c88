-- The ESC as a node on CAN (board esc32v2_can), commanded by esc.RawCommand: the same rise with the same
-- limits, and its watchdog.
include "include/rise.lua"
include "include/silence.lua"

plan "thrust_rise_dronecan" {
  image = "esc", board = "esc32v2_can",
  stand = { prop = "hk_10x4.5", battery = "4s_2200", throttle = "can" },
  tags = { "quick", "esc", "can" },
  timeout = "20 s",
  run = function(t)
    t:wait "500 ms" -- it is silent until it has been spoken to
    t:can { bus = "can1", from = "mcu", message = 1034, period = "50 ms", tolerance = "1.5 ms", during = "4 s" }
    t:can { bus = "can1", load = "5 %", during = "4 s" }
    rise(t)
  end,
}

plan "silence_dronecan" {
  image = "esc", board = "esc32v2_can",
  stand = { prop = "hk_10x4.5", battery = "4s_2200", throttle = "can" },
  tags = { "esc", "can" },
  timeout = "20 s",
  run = function(t)
    fall_silent(t)
  end,
}
