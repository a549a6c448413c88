-- The stock board as it is drawn, with its motor and the propeller of the "HP quad". Constants:
--   whirl calibrate esc test_plans/calibrations/hk_10x4.5.lua --write test_plans/esc/include/hk_10x4.5_calibration.lua
return {
  kind = "calibration",
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", supply = "16.4 V", tolerance = "none" },
  diameter = "10 in",
  updraft = "3.5 m/s", -- as that of the gust crossing
  air_within = "0 %", -- its plans are of the same day
  warm_up = "100 s",   -- the current sense's offset settles
}
