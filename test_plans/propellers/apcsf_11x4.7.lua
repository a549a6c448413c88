-- APC slow fly 11x4.7. Chord and angle: UIUC Propeller Database, volume 1 (Brandt, Selig et al.), taken
-- there from photographs. `static`: measured coefficients at rest; section, drag and twist are fitted on them.
-- Mass is an estimate.
-- Columns: r and c over the tip radius, beta in degrees against the disc.
return {
  kind = "propeller",
  name = "APC slow fly 11x4.7",
  make = "APC",
  blades = 2,
  diameter = "11 in",
  mass = "14 g",
  static = {
    { rpm = 2018, CT = 0.1005, CP = 0.0391 },
    { rpm = 3144, CT = 0.1074, CP = 0.0411 },
    { rpm = 4290, CT = 0.1151, CP = 0.0442 },
    { rpm = 5450, CT = 0.1230, CP = 0.0477 },
  },
  stations = {
    { r = 0.15, c = 0.112, beta = 19.64 },
    { r = 0.20, c = 0.137, beta = 21.81 },
    { r = 0.25, c = 0.160, beta = 22.45 },
    { r = 0.30, c = 0.181, beta = 21.88 },
    { r = 0.35, c = 0.198, beta = 20.73 },
    { r = 0.40, c = 0.211, beta = 19.14 },
    { r = 0.45, c = 0.221, beta = 17.30 },
    { r = 0.50, c = 0.227, beta = 15.58 },
    { r = 0.55, c = 0.230, beta = 14.06 },
    { r = 0.60, c = 0.228, beta = 12.71 },
    { r = 0.65, c = 0.222, beta = 11.53 },
    { r = 0.70, c = 0.213, beta = 10.47 },
    { r = 0.75, c = 0.199, beta = 9.53 },
    { r = 0.80, c = 0.181, beta = 8.63 },
    { r = 0.85, c = 0.158, beta = 7.71 },
    { r = 0.90, c = 0.132, beta = 6.61 },
    { r = 0.95, c = 0.084, beta = 5.28 },
    { r = 1.00, c = 0.035, beta = 3.93 },
  },
}
