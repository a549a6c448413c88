-- A thrust stand with an ESC32v2 class board on this host's USB; docs/bench.md says how it is wired.
-- The numbers of the bridge and the serial lines are those of one table: put in your own.
return {
  bench = "esc_stand",
  board = "esc32v2",
  late = "200 us", late_share = "1 %",
  links = {
    { name = "throttle", bus = "i2c2", bridge = "mcp2221a", rate = "100 kHz" },
    { name = "terminal", bus = "usart1", path = "/dev/ttyUSB0", baud = "921600 baud" },
  },
  instruments = {
    -- A load cell's amplifier and the meters of the supply: "thrust_N bus_V supply_A" at 80 Hz or more.
    { name = "cell", path = "/dev/ttyUSB1", baud = "115200 baud", delay = "6 ms",
      readings = {
        { signal = "thrust", column = 1, scale = "1 N" },
        { signal = "bus_voltage", column = 2, scale = "1 V" },
        { signal = "supply_current", column = 3, scale = "1 A" },
      } },
  },
  signals = { speed = "told_speed" }, -- without a tachometer: the ESC's own word, 20 times a second
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
