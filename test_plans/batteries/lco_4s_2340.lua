-- Four lithium polymer cells (LiCoO2 and graphite in a pouch, 2.28 Ah by name) as measured: discharges at 0.1, 0.5, 1 and 2 times the capacity an hour, about 25 degC, down to
-- 3.0 V [Enertech]. Fitted to the first three (rms 6, 3 and 2 mV of each cell); the last one, kept aside, comes
-- out within 21 mV rms, 37 mV at worst (plant/data/batteries/enertech_spb655060.txt, judged by `whirl validate`). Nothing was measured at other temperatures.
return {
  kind = "battery",
  name = "LiCoO2 pouch, 4S 2340 mAh",
  cells = 4,
  capacity = "2340 mAh",
  open_circuit = {
    { used = 0, V = 4.1813 }, { used = 0.01, V = 4.1759 }, { used = 0.025, V = 4.1648 }, { used = 0.05, V = 4.1483 },
    { used = 0.10, V = 4.0783 }, { used = 0.15, V = 4.0244 }, { used = 0.20, V = 3.9852 }, { used = 0.25, V = 3.9533 },
    { used = 0.30, V = 3.9230 }, { used = 0.40, V = 3.8538 }, { used = 0.45, V = 3.8252 }, { used = 0.50, V = 3.8042 },
    { used = 0.55, V = 3.7872 }, { used = 0.60, V = 3.7743 }, { used = 0.70, V = 3.7516 }, { used = 0.80, V = 3.7225 },
    { used = 0.84, V = 3.7047 }, { used = 0.87, V = 3.6827 }, { used = 0.89, V = 3.6624 }, { used = 0.91, V = 3.6377 },
    { used = 0.93, V = 3.5975 }, { used = 0.95, V = 3.5190 }, { used = 0.965, V = 3.4734 }, { used = 0.98, V = 3.3915 },
    { used = 0.99, V = 3.2644 }, { used = 1, V = 3.0677 },
  },
  resistance = "35 mohm",
  relaxation = { { resistance = "4.9 mohm", time = "16.3 s" }, { resistance = "68.5 mohm", time = "208.8 s" } },
  resistance_over_charge = {
    { used = 0, factor = 1 }, { used = 0.1, factor = 0.5105 }, { used = 0.25, factor = 0.6357 },
    { used = 0.5, factor = 0.6362 }, { used = 0.75, factor = 0.7536 }, { used = 0.85, factor = 0.8825 },
    { used = 0.95, factor = 1.0627 }, { used = 1, factor = 3.4585 },
  },
}
