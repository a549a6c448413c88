-- A controller whose sensors and ESCs are nodes of its CAN bus, which this host plays: on the virtual board, and by
-- --target bench/NAME on metal.
include "include/bench_hover.lua"
include "include/parameter.lua"

bench_hover("bench_hover", "px4fmu_v1_all_can", { "flight", "bench", "can" }, function(t)
  set_parameter(t, "SENS_BUS", 1)
  set_parameter(t, "ESC_BUS", 1)
end)
