-- The pod's board in the place of a flight controller's sensors: its host, on the UART, has the parts themselves.
return {
  board = "pod_with_parts",
  mcu = "stm32f405rg",
  hse = "8 MHz",
  devices = { { name = "host", type = "pod_parts" } },
  watch = { "spi1_handler", "exti15_10_handler", "fw::pod::host_task" },
}
