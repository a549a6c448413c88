-- An STM32F103CB with a terminal on USART1 (PA9) and nothing else: for firmware/timing.
return {
  board = "timing_f103",
  mcu = "stm32f103cb",
  hse = "8 MHz",
  devices = { { name = "terminal", type = "serial", bus = "usart1", baud = "115200 baud" } },
}
