-- PX4FMU v1: STM32F405RG, 24 MHz crystal, MPU6000 on SPI1, ESCs on I2C3, radio on USART2.
-- The data-ready pin is our choice; what is not listed here is not on the bus.
return {
  board = "px4fmu_v1",
  mcu = "stm32f405rg",
  hse = "24 MHz",
  devices = {
    { name = "imu", type = "mpu6000", bus = "spi1", cs = "PB0", int = "PC5" },
    { name = "esc1", type = "esc_i2c", bus = "i2c3", address = 0x29, motor = 1 },
    { name = "esc2", type = "esc_i2c", bus = "i2c3", address = 0x2A, motor = 2 },
    { name = "esc3", type = "esc_i2c", bus = "i2c3", address = 0x2B, motor = 3 },
    { name = "esc4", type = "esc_i2c", bus = "i2c3", address = 0x2C, motor = 4 },
    { name = "radio", type = "mavlink_link", bus = "usart2", baud = "57600 baud",
      params = { uplink_loss = "5 %" } },
  },
  pins = { { name = "led_amber", pin = "PB14" }, { name = "led_blue", pin = "PB15" } },
  watch = { "fw::imu_task", "fw::attitude_task", "fw::position_task", "fw::esc_task", "fw::telemetry_task" },
}
