-- Filters 1 and 2 begin in the air, 30 degrees and a fifth of the scale wrong, while the explicit filter
-- flies (thesis, section 6.6: the scale is 1 after 25 s).
include "include/hover.lua"
include "include/parameter.lua"

plan "filter_convergence" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "150 s",
  run = function(t)
    t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
    set_parameter(t, "EST_FILTER", 0)
    hover(t)
    for _, start in ipairs { { scale = 0.8, tilt = 30 }, { scale = 1.2, tilt = -30 } } do
      local words = string.format("from %g and %g deg: ", start.scale, start.tilt)
      t:step(words)
      set_parameter(t, "EST_START_TILT", start.tilt)
      set_parameter(t, "EST_START_SCALE", start.scale)
      t:within("300 ms", function(s) return s.attitude_error_2_rad > t:quantity "10 deg" end, words .. "it is wrong")
      local r = t:record({ "told_scale_1", "told_scale_2" }, "25 s")
      t:expect(r:settled("0.05", { told_scale_1 = "1" }), words .. "scale of filter 1 within 5 %"):at_most "10 s"
      t:expect(r:settled("0.05", { told_scale_2 = "1" }), words .. "scale of filter 2 within 5 %"):at_most "10 s"
      t:expect(t:value("attitude_error_1", "deg"), words .. "attitude of filter 1 after 25 s"):at_most(1)
      t:expect(t:value("attitude_error_2", "deg"), words .. "attitude of filter 2 after 25 s"):at_most(1)
    end
    end,
}
