-- An STM32F405RG with a terminal on USART2 (PA2) and nothing else: for firmware/timing.
return {
  board = "timing_f405",
  mcu = "stm32f405rg",
  hse = "8 MHz",
  devices = { { name = "terminal", type = "serial", bus = "usart2", baud = "115200 baud" } },
}
