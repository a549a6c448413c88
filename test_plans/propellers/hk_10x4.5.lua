-- Hobbyking 10 x 4.5 slow fly, the propeller of the "HP quad". No drawing of it is published:
-- planform and twist are those of the measured APC 9x4.7 slow flyer, chord x 0.78 and
-- angle + 0.95 deg + 6 deg (r - 0.7), set by the thesis's static thrust, T = 1.789e-7 w^2 - 1.4715e-4 w
-- (N, RPM), a figure of merit near 0.69, and the loss of thrust with inflow that measured slow flyers
-- show.
-- Columns: r and c over the tip radius, beta in degrees against the disc.
return {
  kind = "propeller",
  name = "Hobbyking 10x4.5 slow fly",
  blades = 2,
  diameter = "10 in",
  mass = "7.9 g",
  induced_factor = 1.0,
  polars = { { r = 0.2, file = "e63.polar" }, { r = 0.8, file = "naca4412.polar" } },
  stations = {
    { r = 0.15, c = 0.099, beta = 25.19 },
    { r = 0.20, c = 0.105, beta = 23.23 },
    { r = 0.25, c = 0.123, beta = 24.33 },
    { r = 0.30, c = 0.139, beta = 24.02 },
    { r = 0.35, c = 0.152, beta = 22.92 },
    { r = 0.40, c = 0.163, beta = 21.33 },
    { r = 0.45, c = 0.171, beta = 19.45 },
    { r = 0.50, c = 0.176, beta = 17.93 },
    { r = 0.55, c = 0.177, beta = 16.43 },
    { r = 0.60, c = 0.176, beta = 15.18 },
    { r = 0.65, c = 0.172, beta = 14.28 },
    { r = 0.70, c = 0.165, beta = 13.51 },
    { r = 0.75, c = 0.155, beta = 12.81 },
    { r = 0.80, c = 0.142, beta = 12.20 },
    { r = 0.85, c = 0.126, beta = 11.53 },
    { r = 0.90, c = 0.105, beta = 10.66 },
    { r = 0.95, c = 0.076, beta = 9.17 },
    { r = 1.00, c = 0.045, beta = 7.64 },
  },
}
