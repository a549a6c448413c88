-- A flight controller whose sensors are on SPI and I2C, as are its ESCs: a pod plays them, and nothing turns. docs/bench.md has its
-- first hour, docs/pod.md the pod's pins; test_plans/flight/bench_hover_pod.lua flies on it.
return {
  bench = "flight_with_pod",
  board = "px4fmu_v1_sbus",
  late = "200 us", late_share = "1 %",
  links = {
    -- 3 Mbaud, whatever is said. On CAN: pod = "pod_with_receivers_can", interface = "can0".
    { name = "pod", pod = "pod_with_receivers", path = "/dev/ttyUSB1" },
    { name = "radio", kind = "mavlink", bus = "usart2", path = "/dev/ttyUSB0", baud = "57600 baud" },
  },
  safety = { phrase = "no motor is connected", longest = "60 s", heartbeat = "100 ms" },
}
