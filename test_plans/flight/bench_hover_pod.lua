-- The hover of bench_hover.lua for a controller whose sensors are on SPI and I2C, as are its ESCs: on the virtual board, and
-- by --target bench/NAME on metal with a pod (docs/bench.md).
include "include/bench_hover.lua"

bench_hover("bench_hover_pod", "px4fmu_v1_sbus", { "flight", "bench" })
