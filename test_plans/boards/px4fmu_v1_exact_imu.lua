-- PX4FMU v1 whose inertial sensor has noise and drift, but no zero points and scales of its own: a plan draws them, and
-- so knows them.
local board = include "px4fmu_v1.lua"
board.board = "px4fmu_v1_exact_imu"
for _, device in ipairs(board.devices) do
  if device.name == "imu" then
    device.params = {
      accelerometer = { turn_on_bias = "0 m/s2", scale_error = "0 %" },
      gyroscope = { turn_on_bias = "0 rad/s", scale_error = "0 %" },
    }
  end
end
return board
