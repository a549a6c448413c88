-- A copy out of the bag after its own calibration, its motor's constants told as well: the rise from 2.0 to 3.2 N
-- by RPM and by power, settled, with currents within limits. In still air power tells no inflow, and may claim none: both
-- fly by the map of still air here (in wind: downdraft.lua). As it stands it is seed 1; of others, with
--   whirl calibrate esc test_plans/calibrations/hk_10x4.5_typical.lua --seed 11
--   whirl run test_plans/esc/calibrated.lua --seeds 11 --calibrations results/calibrations/hk_10x4.5_typical
include "include/start.lua"
local stored = include "include/hk_10x4.5_typical_calibration.lua"

local function rise(name, mode, number)
  plan("calibrated_rise_by_" .. name) {
    image = "esc", board = "esc32v2", seed = 1,
    -- As after the 100 s that the current sense needs to warm up.
    stand = {
      prop = "hk_10x4.5", supply = "16.8 V", mode = mode, shunt = { warm_up = "0 A" },
    },
    tags = { "esc" },
    timeout = "30 s",
    run = function(t)
      t:wait "200 ms"
      for _, line in ipairs(stored.set) do t:ask(line, "^ok$") end
      for _, line in ipairs { "identified 1", "set warm_up 0", "mode " .. number } do t:ask(line, "^ok$") end
      start(t, "2 N")
      if number == 5 then t:ask("stream 500", "^ok$") end
      t:wait "2 s"
      t:step "rise"
      local up = t:record({ "thrust", "winding_peak", "bus_peak" }, "1 s", function()
        t:command { thrust = "3.2 N" }
      end)
      ends(t, up, 3.2, "rise")
      t:expect(up:rise_time "thrust", "thrust rise 2.0 to 3.2 N, 10 to 90 %"):at_most "50 ms"
      t:expect(up:overshoot "thrust", "overshoot"):at_most "10 %"
      safe(t, up, "rise")
      if number == 5 then
        local r = t:record({ "esc_observable", "thrust" }, "500 ms")
        t:expect(r:mean "esc_observable", "share of the time that power tells the inflow, in still air"):at_most(0.01)
      end
      t:expect(t:value "armed", "still armed"):equal(1)
    end,
  }
end

rise("rpm", "thrust_by_rpm", 2)
rise("power", "thrust_by_power", 5)
