-- The same rise, commanded over DroneCAN.
include "include/rise.lua"

plan "bench_thrust_rise_can" {
  image = "esc", board = "esc32v2_can",
  stand = { prop = "hk_10x4.5", battery = "4s_2200", throttle = "can" },
  tags = { "esc", "bench", "can" },
  timeout = "20 s",
  run = function(t)
    bench_rise(t)
  end
}
