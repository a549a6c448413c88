-- Wind as the difference between velocity over ground and through the air (filters 1 and 2; thesis, section
-- 6.2): 3 m/s, then 2 m/s more.
include "include/hover.lua"

plan "wind_estimate" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "90 s",
  run = function(t)
    hover(t)
    t:step "3 m/s from the south"
    t:gust { north = "3 m/s", duration = "60 s", edge = "2 s" }
    t:wait "15 s"
    local steady = t:record({ "wind_error_north", "wind_error_east", "attitude_error_1", "attitude_error_2", "offset" }, "10 s")
    t:expect(steady:rms_error { wind_error_north = "0 m/s", wind_error_east = "0 m/s" }, "steady: RMS error"):at_most "0.3 m/s"
    t:expect(steady:rms "attitude_error_2", "attitude of filter 2"):at_most "1 deg"
    t:expect(steady:rms "offset", "off the place"):at_most "10 cm"
    t:step "and 2 m/s from the west"
    t:gust { east = "2 m/s", duration = "40 s", edge = "500 ms" }
    t:wait "10 s"
    local changed = t:record({ "wind_error_north", "wind_error_east" }, "10 s")
    t:expect(changed:max_error { wind_error_north = "0 m/s", wind_error_east = "0 m/s" }, "10 s after the change: largest error"):at_most "0.3 m/s"
  end,
}
