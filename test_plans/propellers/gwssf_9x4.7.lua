-- GWS slow fly 9x4.7. Chord and angle: UIUC Propeller Database, volume 1 (Brandt, Selig et al.), taken
-- there from photographs. `static`: measured coefficients at rest; section, drag and twist are fitted on them.
-- Mass is an estimate.
-- Columns: r and c over the tip radius, beta in degrees against the disc.
return {
  kind = "propeller",
  name = "GWS slow fly 9x4.7",
  make = "GWS",
  blades = 2,
  diameter = "9 in",
  mass = "6 g",
  static = {
    { rpm = 2973, CT = 0.1131, CP = 0.0502 },
    { rpm = 4071, CT = 0.1173, CP = 0.0506 },
    { rpm = 5175, CT = 0.1201, CP = 0.0504 },
    { rpm = 6268, CT = 0.1196, CP = 0.0493 },
  },
  stations = {
    { r = 0.15, c = 0.086, beta = 31.66 },
    { r = 0.20, c = 0.098, beta = 28.22 },
    { r = 0.25, c = 0.125, beta = 25.36 },
    { r = 0.30, c = 0.157, beta = 23.58 },
    { r = 0.35, c = 0.185, beta = 22.05 },
    { r = 0.40, c = 0.206, beta = 20.54 },
    { r = 0.45, c = 0.217, beta = 19.09 },
    { r = 0.50, c = 0.224, beta = 17.68 },
    { r = 0.55, c = 0.227, beta = 16.50 },
    { r = 0.60, c = 0.226, beta = 15.39 },
    { r = 0.65, c = 0.220, beta = 14.27 },
    { r = 0.70, c = 0.211, beta = 13.23 },
    { r = 0.75, c = 0.197, beta = 12.36 },
    { r = 0.80, c = 0.181, beta = 11.50 },
    { r = 0.85, c = 0.162, beta = 10.61 },
    { r = 0.90, c = 0.134, beta = 9.63 },
    { r = 0.95, c = 0.088, beta = 9.11 },
    { r = 1.00, c = 0.040, beta = 8.62 },
  },
}
