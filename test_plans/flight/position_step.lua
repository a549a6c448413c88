-- A step of the commanded position: about 1 s, says the thesis (table 6.1). Response counts from the
-- last bit of the frame that carries the new target, which waits up to 100 ms for its turn.
include "include/hover.lua"
include "include/parameter.lua"

plan "position_step" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "quick", "flight" }, timeout = "60 s",
  run = function(t)
    hover(t)
    judged_step(t)
  end,
}

-- By the attitude of appendix E, which asks for no heading: the same step within the same limits, and the nose, which pointed
-- north, stays there.
plan "position_step without a heading" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "60 s",
  run = function(t)
    t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
    set_parameter(t, "CTL_NO_HEADING", 1)
    hover(t)
    judged_step(t)
    t:expect(t:value "yaw", "nose, from north"):within("-5 deg", "5 deg")
  end,
}
