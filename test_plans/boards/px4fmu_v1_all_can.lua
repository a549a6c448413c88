-- PX4FMU v1 with all that it senses and all ESCs as nodes of CAN2, by DroneCAN: IMU, barometer, magnetometer,
-- GPS, battery monitor. On the board itself are left the radio, the RC receiver and the card. The flight image
-- is told by ESC_BUS = 1 and SENS_BUS = 1.
local board = include "px4fmu_v1_can.lua"
board.board = "px4fmu_v1_all_can"
local nodes = {
  imu = { name = "imu", type = "mpu6000_dronecan", bus = "can2" },
  baro = { name = "baro", type = "ms5611_dronecan", bus = "can2" },
  mag = { name = "mag", type = "hmc5883l_dronecan", bus = "can2", axes = { "+y", "-x", "+z" } },
  gps = { name = "gps", type = "ublox_m8_dronecan", bus = "can2" },
  battery = { name = "battery", type = "battery_dronecan", bus = "can2" },
}
for i, device in ipairs(board.devices) do
  board.devices[i] = nodes[device.name] or device
end
return board
