-- What the plans of the figure 8 share.
include "include/hover.lua"
include "include/parameter.lua"

function to_its_start(t)
  hover(t)
  t:step "to its start"
  t:command { position = { north = "1 m" } }
  t:within("5 s", function(s) return s.path_error_m < 0.05 end, "at its start")
  t:wait "2 s"
end

-- Asked are 5 cm of position and 3 degrees of attitude. Limits are 1.3 times the worst of figure_8's seeds 2 to 21
-- (whirl limits): without the torque of rotor drag the vehicle is 2.97 cm off instead of 2.13, and fails.
-- Attitude: 1.3 times that of a copy of the vehicle whose sensors are on CAN (0.159 and 0.166 degrees, seed 1; the drawing 0.11).
function judged_figure_8(t)
  to_its_start(t)
  t:step "two rounds"
  t:command { figure_8 = {} }
  t:wait "5 s"
  local r = t:record({ "path_error", "north", "east", "height", "tilt", "attitude_error", "attitude_error_2",
                       "told_scale_1", "told_scale_2" }, "40 s")
  t:expect(r:rms "path_error", "RMS of the error of position"):at_most "2.9 cm"
  t:expect(r:max "path_error", "largest error of position"):at_most "8.5 cm"
  -- It was flown, and not stood out.
  t:expect(r:max "north", "to the north"):within("0.95 m", "1.05 m")
  t:expect(r:min "east", "to the west"):within("-1.05 m", "-0.95 m")
  t:expect(r:rms_error("height", "1.1 m"), "height RMS error"):at_most "0.35 cm"
  t:expect(r:rms "attitude_error", "RMS of the error of attitude"):at_most "0.21 deg"
  t:expect(r:rms "attitude_error_2", "the same of filter 2"):at_most "0.22 deg"
  t:step "without feedforward"
  set_parameter(t, "CTL_FEEDFWD", 0)
  t:wait "5 s"
  local without = t:record({ "path_error" }, "20 s")
  t:expect(without:rms "path_error", "without feedforward: RMS of the error of position"):at_least "1.5 cm"
end
