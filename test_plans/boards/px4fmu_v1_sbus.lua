-- PX4FMU v1 whose receiver speaks SBUS on USART1 (J1, pin 7). The board has no inverter: one stands in the cable.
local with_sbus = include "include/sbus.lua"
return with_sbus(include "px4fmu_v1.lua", "px4fmu_v1_sbus")
