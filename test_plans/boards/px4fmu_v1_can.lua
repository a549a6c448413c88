-- PX4FMU v1 as in px4fmu_v1.lua, but for its ESCs: they hang on CAN2 (PB12, PB13 of the header, by a
-- transceiver that is not on the board) and speak DroneCAN. The flight image is told by ESC_BUS = 1.
local board = include "px4fmu_v1.lua"
board.board = "px4fmu_v1_can"
for i, device in ipairs(board.devices) do
  if device.type == "esc_i2c" then
    board.devices[i] = { name = device.name, type = "esc_dronecan", bus = "can2", motor = device.motor }
  end
end
return board
