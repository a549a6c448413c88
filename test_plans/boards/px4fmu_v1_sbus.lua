-- PX4FMU v1 whose receiver speaks SBUS on USART1 (J1, pin 7). The board has no inverter: one stands in the cable.
local board = include "px4fmu_v1.lua"
board.board = "px4fmu_v1_sbus"
for _, device in ipairs(board.devices) do
  if device.name == "rc" then
    device.name, device.type, device.bus, device.params = "sbus", "sbus", "usart1", nil
    device.inverter = true
  end
end
return board
