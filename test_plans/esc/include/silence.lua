-- No valid set-point any more: the motor is off within 0.6 s of the last one, and stays off.
include "include/start.lua"

function fall_silent(t)
  start(t, "2 N")
  t:step "silence"
  t:command { silence = true }
  t:wait "400 ms"
  t:expect(t:value "thrust", "holds on for 0.4 s"):at_least "1.8 N"
  t:wait "180 ms" -- the last write was up to 20 ms before the silence
  local off = t:record({ "winding_peak", "bus_peak" }, "1 s")
  t:expect(off:max "winding_peak", "winding current from 0.58 s on"):at_most "0.1 A"
  t:expect(t:value "armed", "disarmed"):equal(0)
  t:step "set-points again"
  t:command { silence = false }
  local still = t:record({ "winding_peak" }, "1 s")
  t:expect(still:max "winding_peak", "a set-point alone starts nothing"):at_most "0.1 A"
end
