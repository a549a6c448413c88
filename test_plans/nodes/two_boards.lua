-- Two boards in one run: a motor controller on its stand, and a second one whose serial line is wired to the
-- first one's. Each has its own watches and faults. What the left one answers is a command to the right one:
-- "mode 2" sets its mode, its "ok" is none that the left one knows, and the list of commands that this gets for an
-- answer is longer than a line may be.
plan "two_boards" {
  nodes = {
    { name = "left", image = "esc", board = "esc32v2", watch = { "fw::esc::control_task" } },
    { name = "right", image = "esc", board = "esc32v2", watch = { "fw::esc::control_task" } },
  },
  wires = { { from = "left.usart1", to = "right.usart1" } },
  stand = { prop = "hk_10x4.5", supply = "16 V" },
  tags = { "nodes", "quick" },
  timeout = "10 s",
  run = function(t)
    t:wait "200 ms"
    for _, node in ipairs { "left", "right" } do
      t:budget(node .. "/fw::esc::control_task") { period = "1 ms", jitter = "50 us", response = "600 us", during = "1 s", margin = "10 %" }
      t:budget(node .. "/cpu") { busy = "70 %", during = "1 s", margin = "10 %" }
    end
    t:fault { kind = "uart_flip", bus = "right/usart1", start = "500 ms", duration = "300 ms", value = "5 %" }
    for _ = 1, 10 do
      t:ask("get mode", "^mode 2$")
      t:wait "100 ms"
    end
    t:expect(t:value "speed", "nobody has asked the motor to turn"):at_most "1 rad/s"
  end,
}
