-- GWS slow fly 11x4.7. Chord and angle: UIUC Propeller Database, volume 1 (Brandt, Selig et al.), taken
-- there from photographs. `static`: measured coefficients at rest; section, drag and twist are fitted on them.
-- Mass is an estimate.
-- Columns: r and c over the tip radius, beta in degrees against the disc.
return {
  kind = "propeller",
  name = "GWS slow fly 11x4.7",
  make = "GWS",
  blades = 2,
  diameter = "11 in",
  mass = "9 g",
  static = {
    { rpm = 2290, CT = 0.1034, CP = 0.0426 },
    { rpm = 3414, CT = 0.1140, CP = 0.0468 },
    { rpm = 4513, CT = 0.1198, CP = 0.0476 },
    { rpm = 5657, CT = 0.1234, CP = 0.0489 },
  },
  stations = {
    { r = 0.15, c = 0.103, beta = 17.31 },
    { r = 0.20, c = 0.121, beta = 19.83 },
    { r = 0.25, c = 0.145, beta = 20.88 },
    { r = 0.30, c = 0.170, beta = 20.51 },
    { r = 0.35, c = 0.193, beta = 19.91 },
    { r = 0.40, c = 0.211, beta = 18.73 },
    { r = 0.45, c = 0.223, beta = 17.05 },
    { r = 0.50, c = 0.228, beta = 15.34 },
    { r = 0.55, c = 0.231, beta = 13.87 },
    { r = 0.60, c = 0.229, beta = 12.81 },
    { r = 0.65, c = 0.225, beta = 12.02 },
    { r = 0.70, c = 0.217, beta = 11.35 },
    { r = 0.75, c = 0.204, beta = 10.73 },
    { r = 0.80, c = 0.187, beta = 10.21 },
    { r = 0.85, c = 0.166, beta = 9.66 },
    { r = 0.90, c = 0.139, beta = 9.22 },
    { r = 0.95, c = 0.097, beta = 8.93 },
    { r = 1.00, c = 0.055, beta = 8.66 },
  },
}
