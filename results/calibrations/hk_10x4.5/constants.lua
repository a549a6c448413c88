-- Made by: whirl calibrate esc test_plans/calibrations/hk_10x4.5.lua
-- What the ESC is told over its serial line.
return {
  "set gain 0.8903373",
  "set offset 0.1575676",
  "set kt 0.009518035",
  "set no_load 1.215958",
  "set resistance 0.2448412",
  "set overlap 0.0004873202",
  "set inertia 3.513396e-05",
  "set a2 1.540705e-05",
  "set a1 -0.0009977662",
  "set q2 2.034576e-07",
  "set c0 0.09537896",
  "set c1 0.0001160622",
  "set c2 0.198439",
  "set c3 5.068093e-08",
  "set c4 0.002002308",
  "set d0 2.9591",
  "set d1 -115018.2",
}
