-- The stock board's copies out of the bag, each seed another; seed 1's constants, and those of the motor too:
--   whirl calibrate esc test_plans/calibrations/hk_10x4.5_typical.lua --write test_plans/esc/include/hk_10x4.5_typical_calibration.lua
return {
  kind = "calibration",
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", supply = "16.4 V", tolerance = "typical" },
  diameter = "10 in",
  updraft = "3.5 m/s",
  tell_motor = true,
  air_within = "0 %", -- its plans are of the same day
  warm_up = "100 s",
}
