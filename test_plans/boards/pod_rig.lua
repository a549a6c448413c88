-- The pod's board (a bare STM32F405RG, 8 MHz crystal) between a flight controller and a host, both played by a
-- recording of the flight image's own traffic: what test_plans/pod judges it by.
return {
  board = "pod_rig",
  mcu = "stm32f405rg",
  hse = "8 MHz",
  devices = {
    { name = "rig", type = "pod_replay", bus = "spi1", cs = "PA15", int = "PC4", params = { traffic = "../pod/boot.txt" } },
  },
  watch = { "spi1_handler", "exti15_10_handler", "fw::pod::host_task" },
}
