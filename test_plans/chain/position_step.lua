-- A step of the commanded position, by the limits of test_plans/flight/position_step.lua.
include "include/chain.lua"
include "include/flights.lua"

chain_plan("chain position step", { parity = true }, function(t)
  hovers(t)
  t:step "1 m north"
  local r = t:record({ "north", "height", "tilt" }, "6 s", function()
    t:command { position = { north = "1 m" } }
  end)
  t:expect(r:rise_time "north", "rise, 10 to 90 %"):at_most "1 s"
  t:expect(r:response_time "north", "command on the wire to 90 %"):at_most "1.6 s"
  t:expect(r:overshoot "north", "overshoot"):at_most "10 %"
  t:expect(r:rms_error("height", "1.1 m"), "height RMS error"):at_most "5 cm"
  t:expect(r:max "tilt", "tilt"):at_most "20 deg"
  t:expect(r:final "north", "arrives"):within("0.95 m", "1.05 m")
end)
