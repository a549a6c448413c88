-- Two motor controllers whose CANs are one bus, which the left one's board arbitrates: the stand's set-points reach both, each
-- acknowledges the other, and each tells its state 20 times a second, 11 ms after the other one (their numbers are in their flash).
local esc_status = 1034
plan "two_on_can" {
  nodes = {
    { name = "left", image = "esc", board = "esc32v2_can", flash = { "esc_motor_1" } },
    { name = "right", image = "esc", board = "esc32v2_can", flash = { "esc_motor_2" }, may_reset = true },
  },
  wires = { { from = "left.can1", to = "right.can1" } },
  stand = { prop = "hk_10x4.5", supply = "16 V", throttle = "can" },
  tags = { "nodes", "can", "quick" },
  timeout = "10 s",
  run = function(t)
    local function both(during)
      t:can { bus = "left/can1", from = "mcu", message = esc_status, period = "50 ms", tolerance = "1.5 ms", during = during }
      t:can { bus = "left/can1", message = esc_status, period = "25 ms", tolerance = "16 ms", during = during }
      t:can { bus = "left/can1", load = "8 %", during = during }
      t:wait(during)
    end
    t:wait "500 ms"
    both "1 s"
    t:step "one is pulled out"
    t:fault { kind = "board_unplugged", node = "right", duration = "300 ms" }
    t:wait "60 ms"
    t:can { bus = "left/can1", message = esc_status, period = "50 ms", tolerance = "1.5 ms", during = "200 ms" }
    t:wait "1 s"
    t:step "and back"
    both "500 ms"
    t:wait "5 ms"
    t:step "a bit of each frame is spoiled"
    t:fault { kind = "can_bit_error", bus = "left/can1", duration = "30 ms" }
    t:wait "300 ms"
    both "500 ms"
  end,
}
