-- ESC32v2 as in esc32v2.lua, but commanded on CAN (PA11, PA12, by a transceiver that is not on the board)
-- by DroneCAN.
return {
  board = "esc32v2_can",
  mcu = "stm32f103cb",
  hse = "8 MHz",
  devices = {
    { name = "stage", type = "power_stage", bus = "pins", motor = 1 },
    { name = "throttle", type = "can_port", bus = "can1" },
    { name = "receiver", type = "pulse_source", bus = "PA8", motor = 1 },
    { name = "terminal", type = "serial", bus = "usart1", baud = "921600 baud" },
  },
  watch = { "fw::esc::control_task" },
}
