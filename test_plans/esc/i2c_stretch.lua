-- How long the image holds SCL while it answers: 50 writes and 20 reads a second, the rotor at the highest load
-- of its mode; further writes and reads move through all phases of the control tick.
include "include/start.lua"

local function stretch_plan(mode, load)
  plan("i2c_stretch_" .. mode) {
    image = "esc", board = "esc32v2",
    stand = { prop = "hk_10x4.5", battery = "4s_2200", mode = mode },
    tags = { "esc" },
    timeout = "20 s",
    run = function(t)
      t:wait "200 ms"
      t:ask("mode " .. ({ duty = 0, rpm = 1, thrust_by_rpm = 2, power = 4, thrust_by_power = 5 })[mode], "^ok$")
      t:step "start"
      t:within("3 s", function(s) return s.armed == 1 end, "armed after its zeros")
      t:command(load)
      t:within("3 s", function(s) return s.speed_radps > 400 end, "turning fast")
      t:wait "1 s"
      t:ask("stream 500", "^ok$")
      t:step "under load"
      local replies = t:record("i2c_stretch", "5 s", function()
        t:command { i2c_raw = { read = 6, times = 300, every = "7 ms", shift = "7 us" } }
        t:command { i2c_raw = { bytes = "00 00 00", read = 6, times = 300, every = "7 ms", shift = "7 us" } }
      end)
      t:expect(replies:max(), "longest hold of SCL"):at_most "50 us"
      t:expect(replies:max(), "a hold was seen at all"):at_least "1 us"
      t:expect(t:value "i2c_raw_replies", "moving transfers"):equal(600)
      t:expect(t:value "armed", "still armed"):equal(1)
    end,
  }
end

stretch_plan("duty", { duty = "60 %" })
stretch_plan("rpm", { speed = "6000 rpm" })
stretch_plan("thrust_by_rpm", { thrust = "5 N" })
stretch_plan("power", { power = "50 W" })
stretch_plan("thrust_by_power", { thrust = "5 N" })
