-- What one ESC's lead loses: the other three and the flight controller have the whole supply. Depths, and what is ridden
-- out, are those of test_plans/esc/supply_dip.lua.
include "include/chain.lua"
include "include/flights.lua"

-- The stand's rotor keeps 80 % of its thrust: a fifth of a quarter of the weight is missing for 0.2 s at one corner.
chain_plan("chain rides out a dip of one ESC's supply", { timeout = "60 s" }, function(t)
  hovers(t)
  local r = t:record({ "height", "offset", "tilt", "bus_current_3", "thrust_3" }, "3 s", function()
    t:fault { kind = "supply_dip", motor = 3, value = "3 V", duration = "200 ms" }
  end)
  t:expect(r:min "bus_current_3", "the dip arrives: its motor feeds it"):at_most "0.5 A"
  t:expect(r:min "thrust_3", "lowest thrust of its rotor"):at_least "1.5 N"
  t:expect(r:max "height", "highest"):at_most "1.2 m"
  t:expect(r:min "height", "lowest"):at_least "1.0 m"
  t:expect(r:max "tilt", "tilt"):at_most "10 deg"
  t:expect(r:max "offset", "sideways"):at_most "20 cm"
  t:wait "1 s"
  lands(t)
end)

-- Below 12 V an ESC switches off and stays so.
chain_plan("chain loses an ESC to a dip of its supply", { timeout = "60 s" }, function(t)
  hovers(t)
  t:fault { kind = "supply_dip", motor = 3, value = "6 V", duration = "300 ms" }
  t:wait "50 ms"
  cuts(t, "a motor has stopped", 3)
end)
