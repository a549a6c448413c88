-- Two boards in one run: the motor controller on its stand, and a second part whose serial line is wired to
-- the controller's. Each has its own watches and faults; what the second one says, the first one hears as
-- commands that it does not know.
plan "two_boards" {
  nodes = {
    { name = "esc", image = "esc", board = "esc32v2", watch = { "fw::esc::control_task" } },
    { name = "talker", image = "timing_f405", board = "timing_f405", watch = { "fw::timing::end_report()" } },
  },
  wires = { { from = "talker.usart2", to = "esc.usart1" } },
  stand = { prop = "hk_10x4.5", supply = "16 V" },
  tags = { "nodes", "quick" },
  timeout = "10 s",
  run = function(t)
    t:wait "200 ms"
    t:fault { kind = "uart_flip", bus = "talker/usart2", start = "100 ms", duration = "100 ms", value = "5 %" }
    t:budget("esc/fw::esc::control_task") { period = "1 ms", jitter = "50 us", response = "600 us", during = "1 s" }
    t:budget("talker/fw::timing::end_report()") { response = "100 ms", during = "1 s" }
    t:budget("esc/cpu") { busy = "70 %", during = "1 s" }
    t:wait "1 s"
    t:expect(t:value "speed", "nobody has asked the motor to turn"):at_most "1 rad/s"
  end,
}
