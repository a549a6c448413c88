-- APC slow fly 9x4.7. Chord and angle: UIUC Propeller Database, volume 1 (Brandt, Selig et al.), taken
-- there from photographs. `static`: measured coefficients at rest; section, drag and twist are fitted on them.
-- Mass is an estimate.
-- Columns: r and c over the tip radius, beta in degrees against the disc.
return {
  kind = "propeller",
  name = "APC slow fly 9x4.7",
  make = "APC",
  blades = 2,
  diameter = "9 in",
  mass = "8.5 g",
  static = {
    { rpm = 3062, CT = 0.1152, CP = 0.0482 },
    { rpm = 4153, CT = 0.1163, CP = 0.0480 },
    { rpm = 5226, CT = 0.1184, CP = 0.0484 },
    { rpm = 6285, CT = 0.1192, CP = 0.0483 },
  },
  stations = {
    { r = 0.15, c = 0.127, beta = 27.54 },
    { r = 0.20, c = 0.135, beta = 25.28 },
    { r = 0.25, c = 0.158, beta = 26.08 },
    { r = 0.30, c = 0.178, beta = 25.47 },
    { r = 0.35, c = 0.195, beta = 24.07 },
    { r = 0.40, c = 0.209, beta = 22.18 },
    { r = 0.45, c = 0.219, beta = 20.00 },
    { r = 0.50, c = 0.225, beta = 18.18 },
    { r = 0.55, c = 0.227, beta = 16.38 },
    { r = 0.60, c = 0.226, beta = 14.83 },
    { r = 0.65, c = 0.221, beta = 13.63 },
    { r = 0.70, c = 0.212, beta = 12.56 },
    { r = 0.75, c = 0.199, beta = 11.56 },
    { r = 0.80, c = 0.182, beta = 10.65 },
    { r = 0.85, c = 0.161, beta = 9.68 },
    { r = 0.90, c = 0.135, beta = 8.51 },
    { r = 0.95, c = 0.097, beta = 6.72 },
    { r = 1.00, c = 0.058, beta = 4.89 },
  },
}
