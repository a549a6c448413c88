-- A thrust stand whose ESC is commanded on CAN, by DroneCAN; docs/bench.md says how it is wired, and its first hour.
return {
  bench = "esc_on_can",
  board = "esc32v2_can",
  late = "200 us", late_share = "1 %",
  links = {
    { name = "bus", bus = "can1", interface = "can0", rate = "1000000 baud" },
    { name = "terminal", bus = "usart1", path = "/dev/ttyUSB0", baud = "921600 baud" },
  },
  instruments = {
    -- "thrust_N bus_V supply_A", as on esc_stand.
    { name = "cell", path = "/dev/ttyUSB1", baud = "115200 baud", delay = "6 ms",
      readings = {
        { signal = "thrust", column = 1, scale = "1 N" },
        { signal = "bus_voltage", column = 2, scale = "1 V" },
        { signal = "supply_current", column = 3, scale = "1 A" },
      } },
  },
  signals = { speed = "told_speed" }, -- of esc.Status
  safety = {
    phrase = "the propeller is clear",
    longest = "60 s",
    heartbeat = "100 ms",
    limits = {
      { signal = "supply_current", low = "-2 A", high = "22 A" },
      { signal = "told_speed", low = "-100 rpm", high = "9000 rpm" },
    },
  },
}
