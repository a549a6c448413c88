-- The HP quad with its ESCs in mode 5, thrust by power: calibrated on the stand, their current sensors
-- warm and set to the ammeter as the thesis does before it flies so (gain and offset are each ESC's own,
-- so the stand's do not carry over).
local quad = include "hp_quad.lua"
quad.name = "HP quad, thrust by power"
quad.esc.mode = "thrust_by_power"
-- The constants belong to the stand's switched bridge: on a vehicle's averaged motors they read about a
-- percent less power, so an updraft counts as a percent stronger (`shared`, 0.967 on the stand).
quad.esc.calibration = { file = "../esc/include/hk_10x4.5_calibration.lua", gain = 1, offset = 0, warm_up = 0, shared = 0.955 }
quad.esc.shunt = { gain_tolerance = "0 %", warm_up = "0 A" }
return quad
