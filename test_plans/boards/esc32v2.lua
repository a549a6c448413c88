-- ESC32v2: STM32F103CB, 8 MHz crystal. The power stage is wired as io_bridges/rack/models/power_stage.hpp
-- says; a thrust stand commands it on I2C2 (PB10, PB11) or by pulses on PA8, and types on USART1 (PA9, PA10).
return {
  board = "esc32v2",
  mcu = "stm32f103cb",
  hse = "8 MHz",
  devices = {
    { name = "stage", type = "power_stage", bus = "pins", motor = 1 },
    { name = "throttle", type = "i2c_master", bus = "i2c2", params = { rate = "400 kHz" } },
    { name = "receiver", type = "pulse_source", bus = "PA8", motor = 1 },
    { name = "terminal", type = "serial", bus = "usart1", baud = "921600 baud" },
  },
  watch = { "fw::esc::control_task" }, -- plans add the tasks of 3 to 20 kHz where they judge them
}
