-- Speeds by esc.RPMCommand (board esc32v2_can), at both ends of the speed mode's range and between; what is no speed of
-- its range is refused and told, and it stands.
include "include/start.lua"

plan "rpm_command" {
  image = "esc", board = "esc32v2_can",
  stand = { prop = "hk_10x4.5", supply = "16.8 V", mode = "rpm", throttle = "can_rpm" },
  tags = { "esc", "can" },
  timeout = "30 s",
  run = function(t)
    t:wait "200 ms"
    t:step "another mode takes no speeds"
    t:ask("mode 2", "^ok$")
    t:within("3 s", function(s) return s.armed == 1 end, "armed after its zeros")
    t:command { speed = "3500 rpm" }
    t:within("1 s", function(s) return flag(s.esc_flags, 7) end, "told as refused")
    t:wait "500 ms"
    t:expect(t:value "speed", "it stands"):at_most "10 rpm"
    t:command { stop = true }
    t:wait "200 ms"
    t:ask("mode 1", "^ok$")
    start(t, { speed = "3500 rpm" })
    for _, asked in ipairs { "3500 rpm", "1000 rpm", "6000 rpm" } do
      t:step("speed " .. asked)
      t:command { speed = asked }
      t:wait "1500 ms"
      local r = t:record({ "speed", "told_speed", "winding_peak", "bus_peak" }, "500 ms")
      -- As by I2C in the same mode, and half of a step of 2.4 rpm.
      t:expect(math.abs(100 * (r:mean("speed").value / t:quantity(asked) - 1)), "speed off by %, asked " .. asked):at_most(0.5)
      safe(t, r, asked)
    end
    t:expect(flag(t:value("esc_flags").value, 7) and 1 or 0, "none of them was refused"):equal(0)
    t:command { stop = true }
    t:within("5 s", function(s) return s.speed_radps < 20 end, "stands")
  end,
}
