-- The stock board and motor with a smaller propeller.
return {
  kind = "calibration",
  image = "esc", board = "esc32v2",
  stand = { prop = "apcsf_9x4.7", supply = "16.4 V" },
  diameter = "9 in",
  air_within = "0 %", -- its plans are of the same day
  warm_up = "20 s",
}
