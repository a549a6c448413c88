-- Hobbyking 10 x 4.5 slow fly, the propeller of the "HP quad". No drawing is published: planform
-- and twist are those of the measured APC 11x4.7 slow flyer, turned until the static thrust of the
-- thesis (T = 1.789e-7 w^2 - 1.4715e-4 w, w in RPM) is met; nothing else was fitted.
-- Columns: r and c over the tip radius, beta in degrees against the disc.
return {
  kind = "propeller",
  name = "Hobbyking 10x4.5 slow fly",
  blades = 2,
  diameter = "10 in",
  mass = "7.9 g",
  polars = { { r = 0.2, file = "e63.polar" }, { r = 0.8, file = "naca4412.polar" } },
  stations = {
    { r = 0.15, c = 0.112, beta = 20.14 },
    { r = 0.20, c = 0.137, beta = 22.31 },
    { r = 0.25, c = 0.160, beta = 22.95 },
    { r = 0.30, c = 0.181, beta = 22.38 },
    { r = 0.35, c = 0.198, beta = 21.23 },
    { r = 0.40, c = 0.211, beta = 19.64 },
    { r = 0.45, c = 0.221, beta = 17.80 },
    { r = 0.50, c = 0.227, beta = 16.08 },
    { r = 0.55, c = 0.230, beta = 14.56 },
    { r = 0.60, c = 0.228, beta = 13.21 },
    { r = 0.65, c = 0.222, beta = 12.03 },
    { r = 0.70, c = 0.213, beta = 10.97 },
    { r = 0.75, c = 0.199, beta = 10.03 },
    { r = 0.80, c = 0.181, beta = 9.13 },
    { r = 0.85, c = 0.158, beta = 8.21 },
    { r = 0.90, c = 0.132, beta = 7.11 },
    { r = 0.95, c = 0.084, beta = 5.78 },
    { r = 1.00, c = 0.035, beta = 4.43 },
  },
}
