-- The rise, with what a bench can see.
function bench_rise(t)
  t:step "arm"
  t:within("3 s", function(s) return s.armed == 1 end, "armed after its zeros")
  t:step "start"
  t:command { thrust = "2 N" }
  t:within("3 s", function(s) return s.speed_radps > 300 end, "turning")
  t:wait "2 s"
  local low = t:record({ "thrust" }, "500 ms")
  t:expect(low:mean "thrust", "steady at 2 N"):within("1.94 N", "2.06 N")
  t:step "rise"
  local rise = t:record({ "thrust", "supply_current" }, "1 s", function()
    t:command { thrust = "3.2 N" }
  end)
  t:expect(rise:rise_time "thrust", "thrust rise, 10 to 90 %"):at_most "50 ms"
  t:expect(rise:response_time "thrust", "command on the wire to 90 %"):at_most "70 ms"
  t:expect(rise:overshoot "thrust", "overshoot"):at_most "10 %"
  t:expect(rise:final "thrust", "thrust after the rise"):within("3.104 N", "3.296 N")
  t:expect(rise:settled("thrust", "3 %"), "rise settled within 3 %"):at_most "150 ms"
  t:expect(rise:max "supply_current", "supply current"):at_most "22 A"
  t:step "stop"
  t:command { stop = true }
  t:within("3 s", function(s) return s.speed_radps < 50 end, "stands")
end
