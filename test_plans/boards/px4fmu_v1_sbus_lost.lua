-- The same with a receiver that only ever says of its frames that they are lost, and repeats its last.
local board = include "px4fmu_v1_sbus.lua"
board.board = "px4fmu_v1_sbus_lost"
for _, device in ipairs(board.devices) do
  if device.name == "sbus" then device.params = { failsafe_after = "60000 ms" } end
end
return board
