-- A winter's morning: -30 degC on the floor, 0.05 K warmer with each metre. Cold air is dense, so its pressure falls off
-- faster, and a barometer that is read by the standard atmosphere makes more of a height: h_baro / h = T_std / T.
--
-- From 2 m to 22 m above the floor the air has 243.8 K in the mean, the standard at those pressures 288.1 K: 1.182,
-- so 20 m up read 23.64 m. Flown by motion capture, which draws the told height to its own, but not the told climb: that
-- is 3.64 m too much in sum, 0.0607 m/s in the mean of 60 s. The barometer itself wanders by 8 Pa in ten minutes: 3.5 Pa
-- (1 sigma) from one end of a minute to the other, which the standard calls 0.29 m, three times 0.87 m or 0.0145 m/s.
-- The rotors' wash is the same at both ends. All of that before it was flown.
include "include/parameter.lua"

plan "cold air makes the barometer's height too large" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "120 s",
  room = { size = { "40 m", "40 m", "30 m" } },
  air = { temperature = "-30 degC", temperature_gradient = "0.05 K/m" },
  run = function(t)
    t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
    set_parameter(t, "FENCE_TOP", 28)
    t:wait "3 s"
    t:command { arm = true }
    t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
    t:command { takeoff = "2 m" }
    t:within("10 s", function(s) return s.height_m > 1.9 end, "2 m high")
    t:wait "8 s"
    local climb = t:record({ "height", "told_height", "baro_climb_error" }, "60 s", function()
      t:command { position = { height = "22 m" } }
    end)
    t:expect(t:value "height", "it came to 22 m"):within("21.8 m", "22.2 m")
    t:expect(climb:min "height", "from 2 m"):within("1.8 m", "2.2 m")
    t:expect(climb:mean "baro_climb_error", "the barometer's climb beyond the true one"):within("0.046 m/s", "0.075 m/s")
    t:log("the barometer's height over the true one: " .. 1 + 60 * climb:mean("baro_climb_error").value / 20)
  end,
}
