-- The thesis's figure 8 (section 6.7, ground-station state 7): x = cos(pi t / 10), y = sin(2 pi t / 10), 1.1 m
-- high. The ground station tells place, velocity and acceleration ten times a second. And the same path in
-- 8 s a round instead of 20: 1.7 m/s and 15 degrees of tilt, where what the feedforward of rates and
-- accelerations of the attitude does is beyond what the loops correct.
include "include/figure_8.lua"

plan "figure_8" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "120 s",
  run = function(t)
    judged_figure_8(t)
  end,
}

plan "figure_8_fast" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "120 s",
  run = function(t)
    to_its_start(t)
    t:step "two rounds"
    t:command { figure_8 = { period = "8 s" } }
    t:wait "5 s"
    local r = t:record({ "path_error", "height", "tilt", "attitude_error" }, "16 s")
    t:expect(r:rms "path_error", "RMS of the error of position"):at_most "8 cm"
    t:expect(r:max "path_error", "largest error of position"):at_most "16 cm"
    t:expect(r:max "tilt", "largest tilt"):within("12 deg", "18 deg")
    t:expect(r:rms_error("height", "1.1 m"), "height RMS error"):at_most "5 cm"
    t:expect(r:rms "attitude_error", "RMS of the error of attitude"):at_most "3 deg"
    t:step "without feedforward"
    set_parameter(t, "CTL_FEEDFWD", 0)
    t:wait "5 s"
    local without = t:record({ "path_error" }, "16 s")
    t:expect(without:rms "path_error", "without feedforward: RMS of the error of position"):at_least "25 cm"
  end,
}
