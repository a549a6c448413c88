-- An updraft of 2 m/s takes from power what it tells of thrust: the power-based controller must notice, fall back on
-- the static map and say so, not pretend a number. Reported beside it: what thrust does under both controllers.
include "include/start.lua"
include "include/calibration.lua"

plan "updraft" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", supply = "16.4 V", mode = "thrust_by_power" },
  tags = { "esc", "nightly" },
  timeout = "200 s",
  run = function(t)
    calibrated_and_warm(t)
    local function held(verb)
      t:step(verb)
      t:ask("arm", "^ok$")
      t:ask(verb .. " 3.2", "^ok$")
      t:wait "1500 ms"
      t:gust { down = "-2 m/s", edge = "300 ms" }
      t:wait "1200 ms"
      local r = t:record({ "thrust", "speed", "esc_observable", "esc_thrust" }, "2 s")
      local answer = t:ask("inflow", "^ls ")
      t:gust { down = "0 m/s", edge = "300 ms" }
      t:ask("stop", "^ok$")
      t:wait_until(function(s) return s.speed_radps < 5 end, "5 s")
      t:wait "2 s"
      t:log(string.format("%s: thrust %.3f N at %.0f rpm, observable %.2f, %s", verb, r:mean("thrust").value,
        r:mean("speed").value * 9.5493, r:mean("esc_observable").value, answer))
      return r
    end
    local by_rpm, by_power = held "thrust", held "st"
    t:expect(by_power:mean "esc_observable", "share of the time that power is held to tell inflow"):at_most(0.05)
    t:expect(math.abs(100 * (by_power:mean("thrust").value / by_rpm:mean("thrust").value - 1)), "thrust off that of the RPM controller, %"):at_most(1)
    t:expect(math.abs(100 * (by_power:mean("esc_thrust").value / 3.2 - 1)), "believed thrust off the static map's, %"):at_most(1)
  end,
}
