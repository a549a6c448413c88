-- The same with a receiver that speaks SBUS on USART1, through an inverter in its cable.
local board = include "px4fmu_v1_all_can.lua"
board.board = "px4fmu_v1_all_can_sbus"
for _, device in ipairs(board.devices) do
  if device.name == "rc" then
    device.name, device.type, device.bus, device.params = "sbus", "sbus", "usart1", nil
    device.inverter = true
  end
end
return board
