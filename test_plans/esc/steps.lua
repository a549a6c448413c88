-- Steps of thrust on a full, a used and a nearly empty pack. The ESC arms at 16.8 V each time; what the supply
-- lacks is taken from it when the rotor turns.
-- 20 A alone would rise from 0.8 to 4.0 N in 53 ms (10 to 90 %; the image's own constants).
-- Left out: the bound of 10 % above those 53 ms, other inertias, the power-based controller, open loop.
include "include/start.lua"

local function steps(name, missing)
  plan("thrust_steps_" .. name) {
    image = "esc", board = "esc32v2",
    stand = { prop = "hk_10x4.5", supply = "16.8 V" },
    tags = { "esc" },
    timeout = "20 s",
    run = function(t)
      start(t, "3.2 N")
      if missing then t:fault { kind = "supply_dip", value = missing } end
      t:wait "1 s"
      local signals = { "thrust", "winding_peak", "bus_peak" }
      t:step "fall"
      local fall = t:record(signals, "1 s", function() t:command { thrust = "2 N" } end)
      t:expect(fall:mean "thrust", "mean after the fall"):within("1.8 N", "2.4 N")
      t:expect(fall:fall_time "thrust", "thrust fall 3.2 to 2.0 N"):at_most "70 ms"
      t:expect(fall:max "winding_peak", "winding current, fall"):at_most "30 A"
      t:step "large step"
      t:command { thrust = "0.8 N" }
      t:wait "2 s"
      local rise = t:record(signals, "1 s", function() t:command { thrust = "4 N" } end)
      t:expect(rise:final "thrust", "thrust after the step"):within("3.6 N", "4.4 N")
      t:expect(rise:rise_time "thrust", "thrust rise 0.8 to 4.0 N"):at_most "70 ms"
      t:expect(rise:max "winding_peak", "winding current, rise"):at_most "30 A"
      t:expect(rise:max "bus_peak", "bus current, rise"):at_most "22 A"
      t:expect(t:value "armed", "still armed"):equal(1)
      t:expect(t:value "shoot_through", "legs shorted"):equal(0)
    end,
  }
end

steps("16v8")
steps("15v7", "1.1 V")
steps("14v0", "2.8 V")
