-- The thesis's figure 8, one round in 20 s, by the limits of test_plans/flight/include/figure_8.lua.
include "include/chain.lua"
include "include/flights.lua"

chain_plan("chain figure 8", { timeout = "90 s", parity = true }, function(t)
  hovers(t)
  t:step "to its start"
  t:command { position = { north = "1 m" } }
  t:within("5 s", function(s) return s.path_error_m < 0.05 end, "at its start")
  t:wait "2 s"
  t:step "a round"
  t:command { figure_8 = {} }
  t:wait "5 s"
  local r = t:record({ "path_error", "north", "east", "height", "attitude_error", "attitude_error_2" }, "20 s")
  t:expect(r:rms "path_error", "RMS of the error of position"):at_most "2.9 cm"
  t:expect(r:max "path_error", "largest error of position"):at_most "8.5 cm"
  t:expect(r:max "north", "to the north"):within("0.95 m", "1.05 m")
  t:expect(r:min "east", "to the west"):within("-1.05 m", "-0.95 m")
  t:expect(r:rms_error("height", "1.1 m"), "height RMS error"):at_most "0.35 cm"
  t:expect(r:rms "attitude_error", "RMS of the error of attitude"):at_most "0.15 deg"
  t:expect(r:rms "attitude_error_2", "the same of filter 2"):at_most "0.16 deg"
end)
