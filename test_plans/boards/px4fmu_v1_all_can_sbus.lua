-- The same with a receiver that speaks SBUS on USART1, through an inverter in its cable.
local with_sbus = include "include/sbus.lua"
return with_sbus(include "px4fmu_v1_all_can.lua", "px4fmu_v1_all_can_sbus")
