-- Made by: whirl calibrate esc test_plans/calibrations/hk_10x4.5.lua --write test_plans/esc/include/hk_10x4.5_calibration.lua
-- What the ESC is told over its serial line, SI.
calibration = {
  "set gain 1.03698",
  "set offset 0.001666465",
  "set loss_ohm 0.103315",
  "set loss_volt 0.9119333",
  "set drag 0.007528376",
  "set inertia 3.933877e-05",
  "set c0 0.07327388",
  "set c1 0.0001059174",
  "set c2 0.2115293",
  "set c3 6.527456e-08",
  "set c4 0.002002308",
  "set d0 3.738515",
  "set d1 -145447.7",
  "set a2 8.290989e-06",
  "set a1 0.0002593294",
  "set a3 9.300432e-09",
  "set q2 1.818624e-07",
  "set q3 -5.459444e-11",
  "set q4 2.069218e-13",
  "set shared 0.975449",
}
return { kind = "esc_calibration", set = calibration }
