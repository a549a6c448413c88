-- The motor of the HP quad, behind an ESC32v2 and its leads, with a 10 x 4.5 propeller on it: the plant's own
-- (plant/motor/motor_params.hpp says where each figure is from).
return {
  kind = "motor",
  name = "Turnigy D2836/9",
  kv_rpm_per_V = 950,
  resistance = "120 mohm", winding_resistance = "70 mohm", inductance = "20 uH",
  no_load_current = "1 A", inertia = "3.752e-5 kg m2", pole_pairs = 7,
}
