-- The HP quad with its ESCs in mode 5, thrust by power: calibrated on the stand, their current sensors
-- warm and set to the ammeter as the thesis does before it flies so (gain and offset are each ESC's own,
-- so the stand's do not carry over). The constants are those of the stand's motor and propeller, and of its switched
-- bridge. What this copy's four take, the ESCs are told before each flight: warmed up at the thrust of hover in still
-- air, `still` (harness/flight/still_air.hpp).
local quad = include "hp_quad.lua"
quad.name = "HP quad, thrust by power"
quad.esc.mode = "thrust_by_power"
quad.esc.still_air = { thrust = "2.2 N", warm_up = "60 s" }
-- `shared` 0.967 is what the stand saw in an updraft of 3.5 m/s. In flight the balance errs by one to two percent of power
-- more: bearings that go on warming up, thrusts other than that of `still`. So 0.935 (docs/chapter_6.md).
quad.esc.calibration = { file = "../esc/include/hk_10x4.5_calibration.lua", gain = 1, offset = 0, warm_up = 0, shared = 0.935 }
quad.esc.shunt = { gain_tolerance = "0 %", warm_up = "0 A" }
return quad
