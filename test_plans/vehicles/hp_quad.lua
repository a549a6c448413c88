-- The "HP quad" of M. Bangura's thesis (ANU, 2017), plus layout: motor 1 front, 2 right, 3 rear,
-- 4 left; 1 and 3 turn counter-clockwise seen from above. Inertia, gear and rotor height are not in
-- the thesis: inertia from the parts list, the rest measured on such frames.
return {
  kind = "vehicle",
  name = "HP quad",
  mass = "900 g",
  inertia = { "0.0125 kg m2", "0.0125 kg m2", "0.0235 kg m2" },
  arm = "25 cm",
  rotor_height = "3 cm", -- of the rotor plane above the centre of mass
  propeller = "../propellers/hk_10x4.5.lua",
  gear = { half_span = "12 cm", below = "10 cm", foot_radius = "1 cm", restitution = 0.3, friction = 0.8 },
  rotor_drag_s_per_m = 0.033, -- what the blade elements (0.007) lack of the measured 0.04
  -- Of the frame without propellers, along x, y, z. No measurement: estimated from an X frame of that
  -- span. From ahead: two arms of 19 cm x 12 mm, plates with boards and battery 10 x 4 cm, three motors of
  -- 28 x 28 mm, two legs of 10 cm x 8 mm. From above: four arms, plates 12 x 12 cm, four motors, four
  -- ESCs that show 45 x 13 mm beside their arm. Coefficients: round and square bars 1.0 to 1.2,
  -- a short cylinder 0.75, a plate 1.15 [Hoerner]
  frontal_areas_m2 = { 0.0125, 0.0125, 0.0283 },
  drag_coefficients = { 1.0, 1.0, 1.15 },
  avionics_current = "250 mA",
  motor = { -- Turnigy D2836/9 with ESC32v2 and leads, line to line
    kv_rpm_per_V = 950,
    resistance = "120 mohm",
    winding_resistance = "70 mohm",
    inductance = "20 uH",
    no_load_current = "1 A",
    inertia = "3.752e-5 kg m2", -- with propeller
    pole_pairs = 7,
  },
  battery = "4s_2200",
  tolerance = "typical", -- each seed is another copy; "none" (--set vehicle.tolerance=none) is this drawing itself
  esc = { mode = "thrust_by_rpm", max_current = "20 A", arming_voltage = "15.7 V" },
  capture = { camera_rate = "200 Hz", rate = "40 Hz", latency = "8 ms", position_noise = "1 mm", angle_noise = "0.002 rad" },
}
