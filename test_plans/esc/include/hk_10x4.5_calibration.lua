-- Made by: whirl calibrate esc test_plans/calibrations/hk_10x4.5.lua --write test_plans/esc/include/hk_10x4.5_calibration.lua
-- What the ESC is told over its serial line, SI.
calibration = {
  "set gain 1.037541",
  "set offset 0.001666465",
  "set loss_ohm 0.1169994",
  "set loss_volt 0.6308301",
  "set drag 0.009906326",
  "set inertia 3.941426e-05",
  "set c0 0.07428263",
  "set c1 0.0001060284",
  "set c2 0.2110051",
  "set c3 6.543583e-08",
  "set c4 0.002002308",
  "set d0 3.592165",
  "set d1 -136929.8",
  "set a2 8.299793e-06",
  "set a1 0.0002573236",
  "set a3 9.290904e-09",
  "set q2 1.800343e-07",
  "set q3 -4.777601e-11",
  "set q4 2.00972e-13",
  "set shared 0.9754388",
}
return { kind = "esc_calibration", set = calibration }
