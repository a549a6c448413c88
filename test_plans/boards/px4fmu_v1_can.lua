-- PX4FMU v1 as in px4fmu_v1.lua, but for its ESCs: they hang on CAN2 (PB12, PB13 of the header, by a
-- transceiver that is not on the board) and speak DroneCAN. The flight image is told by ESC_BUS = 1.
return {
  board = "px4fmu_v1_can",
  mcu = "stm32f405rg",
  hse = "24 MHz",
  devices = {
    { name = "imu", type = "mpu6000", bus = "spi1", cs = "PB0", int = "PC3" },
    { name = "baro", type = "ms5611", bus = "i2c2", address = 0x76 },
    { name = "mag", type = "hmc5883l", bus = "i2c2", address = 0x1E, drdy = "PB1", axes = { "+y", "-x", "+z" } },
    { name = "battery", type = "battery_sense", bus = "PC0" },
    { name = "card", type = "sd_card", bus = "spi3", cs = "PA4" },
    { name = "esc1", type = "esc_dronecan", bus = "can2", motor = 1 },
    { name = "esc2", type = "esc_dronecan", bus = "can2", motor = 2 },
    { name = "esc3", type = "esc_dronecan", bus = "can2", motor = 3 },
    { name = "esc4", type = "esc_dronecan", bus = "can2", motor = 4 },
    { name = "radio", type = "mavlink_link", bus = "usart2", baud = "57600 baud",
      params = { uplink_loss = "5 %" } },
    { name = "gps", type = "ublox_6", bus = "usart6" },
    { name = "rc", type = "cppm", bus = "PA10", params = { failsafe = "stop" } },
  },
  pins = { { name = "led_amber", pin = "PB14" }, { name = "led_blue", pin = "PB15" } },
  watch = { "fw::imu_task", "fw::attitude_task", "fw::position_task", "fw::esc_task", "fw::sensor_task", "fw::gps_task", "fw::telemetry_task",
            "fw::log_task",
            "fw::Estimator::step_explicit", "fw::Estimator::step_aided" },
}
