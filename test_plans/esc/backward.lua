-- A rotor that rising air turns backward, as a vehicle's do that falls with its motors off: it is neither joined nor
-- left alone until the start counts as a stall, but braked by the alignment and started.
include "include/start.lua"

for _, speed in ipairs { 50, 100, 200 } do
  plan("backward at " .. speed .. " rad/s") {
    image = "esc", board = "esc32v2",
    stand = { prop = "hk_10x4.5", supply = "16.4 V" },
    tags = { "esc" },
    timeout = "30 s",
    run = function(t)
      t:within("3 s", function(s) return s.armed == 1 end, "armed after its zeros")
      t:step "driven backward"
      t:command { brake = "-20 mN m" } -- friction takes half of it
      t:within("2 s", function(s) return s.speed_radps < -speed end, "turns backward")
      t:command { brake = "-12 mN m" } -- and goes on speeding it up
      t:step "started against it"
      local start = t:record({ "thrust", "speed", "winding_peak", "bus_peak" }, "1.5 s", function() t:command { thrust = "2 N" } end)
      t:expect(start:response_time "thrust", "90 % of the thrust"):at_most "600 ms"
      t:expect(start:final "thrust", "thrust"):within("1.95 N", "2.05 N")
      safe(t, start)
      t:expect(t:value "armed", "armed"):equal(1)
    end,
  }
end
