-- Hobbyking 10 x 4.5 slow fly, the propeller of the "HP quad". No drawing of it is published: a copy of
-- the thin GWS slow flyers, so planform and twist are those of the measured GWS 11x4.7, chord x 0.66 and
-- angle + 2.2 deg - 10 deg (r - 0.7), in nylon as GWS, sections BW-3 to E63, set by the thesis's static thrust,
-- T = 1.789e-7 w^2 - 1.4715e-4 w (N, RPM), a figure of merit near 0.66, and the loss of thrust and power
-- with inflow that measured slow flyers show.
-- Columns: r and c over the tip radius, beta in degrees against the disc.
return {
  kind = "propeller",
  name = "Hobbyking 10x4.5 slow fly",
  blades = 2,
  diameter = "10 in",
  mass = "7.9 g",
  induced_factor = 1.13,
  material = "nylon",
  thickness = 0.065,
  polars = { { r = 0.2, file = "bw3.polar" }, { r = 0.9, file = "e63.polar" } },
  stations = {
    { r = 0.15, c = 0.0680, beta = 25.01 },
    { r = 0.20, c = 0.0799, beta = 27.03 },
    { r = 0.25, c = 0.0957, beta = 27.58 },
    { r = 0.30, c = 0.1122, beta = 26.71 },
    { r = 0.35, c = 0.1274, beta = 25.61 },
    { r = 0.40, c = 0.1393, beta = 23.93 },
    { r = 0.45, c = 0.1472, beta = 21.75 },
    { r = 0.50, c = 0.1505, beta = 19.54 },
    { r = 0.55, c = 0.1525, beta = 17.57 },
    { r = 0.60, c = 0.1511, beta = 16.01 },
    { r = 0.65, c = 0.1485, beta = 14.72 },
    { r = 0.70, c = 0.1432, beta = 13.55 },
    { r = 0.75, c = 0.1346, beta = 12.43 },
    { r = 0.80, c = 0.1234, beta = 11.41 },
    { r = 0.85, c = 0.1096, beta = 10.36 },
    { r = 0.90, c = 0.0917, beta = 9.42 },
    { r = 0.95, c = 0.0640, beta = 8.63 },
    { r = 1.00, c = 0.0363, beta = 7.86 },
  },
}
