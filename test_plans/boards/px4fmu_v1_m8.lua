-- PX4FMU v1 with a NEO-M8 in place of the LEA-6: another name, for each of its faults is flown, too.
local board = include "px4fmu_v1.lua"
board.board = "px4fmu_v1_m8"
for _, device in ipairs(board.devices) do
  if device.name == "gps" then device.name, device.type = "m8", "ublox_m8" end
end
return board
