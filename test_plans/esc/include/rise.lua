-- Arms, starts, holds 2 N, rises to 3.2 N, stops.
include "include/start.lua"

function rise(t)
  t:step "arm"
  t:within("3 s", function(s) return s.armed == 1 end, "armed after its zeros")
  t:step "start"
  t:command { thrust = "2 N" }
  t:within("3 s", function(s) return s.speed_radps > 300 end, "turning")
  ends(t, t:record({ "thrust", "speed" }, "1 s"), 2, "start, once it turns,")
  t:wait "1 s"
  local low = t:record({ "thrust" }, "500 ms")
  t:expect(low:mean "thrust", "steady at 2 N"):within("1.94 N", "2.06 N")
  t:step "rise"
  local rise = t:record({ "thrust", "winding_peak", "bus_peak" }, "1 s", function()
    t:command { thrust = "3.2 N" }
  end)
  t:expect(rise:rise_time "thrust", "thrust rise, 10 to 90 %"):at_most "50 ms"
  t:expect(rise:response_time "thrust", "command on the wire to 90 %"):at_most "70 ms"
  t:expect(rise:overshoot "thrust", "overshoot"):at_most "10 %"
  ends(t, rise, 3.2, "rise")
  safe(t, rise)
  t:step "stop"
  t:command { stop = true }
  t:within("3 s", function(s) return s.speed_radps < 50 end, "stands")
  t:expect(t:value "shoot_through", "legs shorted"):equal(0)
end
