-- As px4fmu_v1_all_can.lua, its IMU's samples at their full 16 bits, in three frames.
local board = include "px4fmu_v1_all_can.lua"
board.board = "px4fmu_v1_all_can_16"
for _, device in ipairs(board.devices) do
  if device.name == "imu" then device.params = { message = "imu16" } end
end
return board
