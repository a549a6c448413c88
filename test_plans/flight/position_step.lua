-- A step of the commanded position: about 1 s, says the thesis (table 6.1). Response counts from the
-- last bit of the frame that carries the new target, which waits up to 100 ms for its turn.
include "include/hover.lua"

plan "position_step" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "quick", "flight" }, timeout = "60 s",
  run = function(t)
    hover(t)
    judged_step(t)
  end,
}
