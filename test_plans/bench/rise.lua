-- The thrust rise with what a bench can see: no winding current, no truth. Runs on the virtual stand and, by
-- --target bench/NAME, on metal; a load cell of 500 readings a second tells a rise to 2 ms.
include "include/rise.lua"

plan "bench_thrust_rise" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", battery = "4s_2200" },
  tags = { "esc", "bench" },
  timeout = "20 s",
  run = function(t)
    bench_rise(t)
  end
}
