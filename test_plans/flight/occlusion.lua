-- Markers that a camera sees now and then: four frames in five of the motion-capture system give no pose, each by itself. Of the five
-- frames between two poses of the radio all are hidden in 0.8^5 of the cases: a third of the poses are missing, beside the 5 % that
-- the radio loses, and those that come are up to 20 ms older. The hover and the thesis's figure 8 are held as without: what is asked
-- is what is asked there (10 cm; 5 cm and 3 degrees).
include "include/figure_8.lua"

plan "figure_8, a third of the poses hidden" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad", vehicle_with = { ["capture.occlusion_chance"] = "80 %" },
  tags = { "flight" }, timeout = "90 s",
  run = function(t)
    to_its_start(t)
    t:step "hover"
    local still = t:record({ "path_error", "height", "attitude_error", "told_state" }, "8 s")
    t:expect(still:rms "path_error", "hover: RMS distance"):at_most "10 cm"
    t:expect(still:rms_error("height", "1.1 m"), "hover: height RMS error"):at_most "5 cm"
    t:expect(still:rms "attitude_error", "hover: RMS of the error of attitude"):at_most "1 deg"
    t:step "a round"
    t:command { figure_8 = {} }
    t:wait "5 s"
    local before = t:value "capture_poses"
    local r = t:record({ "path_error", "attitude_error", "told_state" }, "20 s")
    t:expect(r:rms "path_error", "RMS of the error of position"):at_most "5 cm"
    t:expect(r:rms "attitude_error", "RMS of the error of attitude"):at_most "3 deg"
    t:expect(r:max "told_state", "it flies on"):at_most(2)
    -- 0.672 of 800, with a sigma of 13.3; five of them.
    t:expect(t:value("capture_poses").value - before.value, "poses that the cameras had in that time"):within(471, 604)
    t:command { land = true }
    t:within("10 s", function(s) return s.told_armed == 0 end, "landed and disarmed")
  end,
}
