-- Hobbyking 10 x 4.5 slow fly, the propeller of the "HP quad". No drawing of it is published:
-- planform and twist are those of the measured APC 9x4.7 slow flyer, chord x 0.77 and
-- angle + 1.2 deg + 6 deg (r - 0.7), set by the thesis's static thrust, T = 1.789e-7 w^2 - 1.4715e-4 w
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
    { r = 0.15, c = 0.098, beta = 25.44 },
    { r = 0.20, c = 0.104, beta = 23.48 },
    { r = 0.25, c = 0.122, beta = 24.58 },
    { r = 0.30, c = 0.137, beta = 24.27 },
    { r = 0.35, c = 0.150, beta = 23.17 },
    { r = 0.40, c = 0.161, beta = 21.58 },
    { r = 0.45, c = 0.169, beta = 19.70 },
    { r = 0.50, c = 0.173, beta = 18.18 },
    { r = 0.55, c = 0.175, beta = 16.68 },
    { r = 0.60, c = 0.174, beta = 15.43 },
    { r = 0.65, c = 0.170, beta = 14.53 },
    { r = 0.70, c = 0.163, beta = 13.76 },
    { r = 0.75, c = 0.153, beta = 13.06 },
    { r = 0.80, c = 0.140, beta = 12.45 },
    { r = 0.85, c = 0.124, beta = 11.78 },
    { r = 0.90, c = 0.104, beta = 10.91 },
    { r = 0.95, c = 0.075, beta = 9.42 },
    { r = 1.00, c = 0.045, beta = 7.89 },
  },
}
