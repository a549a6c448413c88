-- A step of the commanded position: about 1 s, says the thesis (table 6.1). Response counts from the
-- last bit of the frame that carries the new target, which waits up to 100 ms for its turn.
include "include/hover.lua"

plan "position_step" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "quick", "flight" }, timeout = "60 s",
  run = function(t)
    hover(t)
    t:step "1 m north"
    local r = t:record({ "north", "height", "tilt" }, "6 s", function()
      t:command { position = { north = "1 m" } }
    end)
    t:expect(r:rise_time "north", "rise, 10 to 90 %"):at_most "1 s"
    t:expect(r:response_time "north", "command on the wire to 90 %"):at_most "1.6 s"
    t:expect(r:overshoot "north", "overshoot"):at_most "10 %"
    t:expect(r:rms_error("height", "1.1 m"), "height RMS error"):at_most "5 cm"
    t:expect(r:max "tilt", "tilt"):at_most "20 deg"
    t:expect(r:final "north", "arrives"):within("0.95 m", "1.05 m")
  end,
}
