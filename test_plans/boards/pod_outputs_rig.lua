-- The pod's board with its host on CAN, and a GPS and a receiver that the host plays: what test_plans/pod judges its outputs by.
return {
  board = "pod_outputs_rig",
  mcu = "stm32f405rg",
  hse = "8 MHz",
  devices = {
    { name = "host", type = "pod_host", cppm = "PB6", baud = "57600 baud", params = { can = 2 } },
  },
  watch = { "tim4_handler", "can2_rx0_handler", "can2_tx_handler", "dma2_stream6_handler", "fw::pod::host_task" },
}
