-- Made by: whirl calibrate esc test_plans/calibrations/hk_10x4.5.lua --write test_plans/esc/include/hk_10x4.5_calibration.lua
-- What the ESC is told over its serial line, SI.
calibration = {
  "set gain 1.033322",
  "set offset -0.01524993",
  "set loss_ohm 0.1164278",
  "set loss_volt 0.6452805",
  "set drag 0.009785632",
  "set inertia 3.931014e-05",
  "set c0 0.07402473",
  "set c1 0.0001060127",
  "set c2 0.2110006",
  "set c3 6.543576e-08",
  "set c4 0.002002308",
  "set d0 3.631464",
  "set d1 -139459.8",
  "set a2 8.30203e-06",
  "set a1 0.0002569437",
  "set a3 9.287987e-09",
  "set q2 1.797771e-07",
  "set q3 -4.632242e-11",
  "set q4 1.98835e-13",
  "set shared 0.9756592",
}
return { kind = "esc_calibration", set = calibration }
