-- PX4FMU v1 whose magnetometer sits near the cables: the motors' at ten times what the stock board has, and
-- the pack's: 1 uT/A is what one lead of a pair adds at 20 cm.
local board = include "px4fmu_v1.lua"
board.board = "px4fmu_v1_cables"
for _, device in ipairs(board.devices) do
  if device.name == "mag" then
    device.params = {
      motor_field_1 = { "0.4 uT", "0 uT", "0.2 uT" },
      motor_field_2 = { "0 uT", "0.4 uT", "0.2 uT" },
      motor_field_3 = { "-0.4 uT", "0 uT", "0.2 uT" },
      motor_field_4 = { "0 uT", "-0.4 uT", "0.2 uT" },
      pack_field = { "0.8 uT", "0.6 uT", "0.4 uT" },
    }
  end
end
return board
