-- PX4FMU v1 whose SD card has one MiB left.
local board = include "px4fmu_v1.lua"
board.board = "px4fmu_v1_full_card"
for _, device in ipairs(board.devices) do
  if device.name == "card" then device.size, device.free = "64 MiB", "1 MiB" end
end
return board
