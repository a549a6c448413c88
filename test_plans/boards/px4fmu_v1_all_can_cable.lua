-- px4fmu_v1_all_can.lua with a cable in its radio's place, as a bench may have: nothing is lost, and nothing waits for the air.
local board = include "px4fmu_v1_all_can.lua"
board.board = "px4fmu_v1_all_can_cable"
for _, device in ipairs(board.devices) do
  if device.name == "radio" then device.params = { air_bytes_per_s = 1e9 } end
end
return board
