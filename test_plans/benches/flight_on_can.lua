-- A flight controller whose sensors and ESCs are nodes of its CAN: this host plays them all, and nothing turns. docs/bench.md
-- has its first hour; test_plans/flight/bench_hover.lua flies on it.
return {
  bench = "flight_on_can",
  board = "px4fmu_v1_all_can",
  late = "200 us", late_share = "1 %",
  links = {
    { name = "bus", bus = "can2", interface = "can0", rate = "1000000 baud" },
    { name = "radio", kind = "mavlink", bus = "usart2", path = "/dev/ttyUSB0", baud = "57600 baud" },
  },
  safety = { phrase = "no motor is connected", longest = "60 s", heartbeat = "100 ms" },
}
