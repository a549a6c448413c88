-- Ten minutes of hover on one pack, as one motor of four feels it: the voltage falls as in flight
-- [Bangura 2017, fig. 2.11], the thrust stays.
include "include/start.lua"

plan "battery_sag" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", battery = { pack = "4s_2200", share = "25 %" } },
  tags = { "esc", "nightly" },
  timeout = "620 s",
  run = function(t)
    t:within("3 s", function(s) return s.armed == 1 end, "armed after its zeros")
    t:expect(t:value "bus_voltage", "at rest"):within("16.4 V", "16.9 V")
    start(t, "2.2 N")
    local first_N = t:value("thrust", "N")
    t:expect(first_N, "thrust at first, N"):within(2.1, 2.3)
    t:step "ten minutes"
    local all = t:record({ "thrust", "bus_voltage", "bus_current", "speed" }, "597 s")
    t:expect(all:max_error { thrust = string.format("%.4f N", first_N) }, "thrust off its first value")
      :at_most "0.044 N" -- 2 %
    t:expect(all:final "bus_voltage", "after ten minutes"):within("14.5 V", "15.0 V")
    t:expect(all:mean "bus_current", "mean bus current"):within("1.2 A", "1.6 A")
    t:expect(t:value "charge_used", "charge of a quarter of the pack"):at_most "1000 C"
    t:expect(t:value "armed", "still armed"):equal(1)
  end,
}
