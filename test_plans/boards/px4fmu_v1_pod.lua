-- PX4FMU v1 on a bench with a pod: what the pod plays (IMU, barometer, magnetometer, ESCs), the card, the radio, and the
-- divider on the bench's supply. No GPS and no receiver.
local board = include "px4fmu_v1.lua"
board.board = "px4fmu_v1_pod"
local kept = {}
for _, device in ipairs(board.devices) do
  if device.name ~= "gps" and device.name ~= "rc" then kept[#kept + 1] = device end
end
board.devices = kept
return board
