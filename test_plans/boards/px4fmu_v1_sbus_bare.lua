-- The same without the inverter: what USART1 reads is garbage.
local board = include "px4fmu_v1_sbus.lua"
board.board = "px4fmu_v1_sbus_bare"
for _, device in ipairs(board.devices) do
  if device.name == "sbus" then device.inverter = nil end
end
return board
