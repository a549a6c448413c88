-- Ten starts from rest, each from where the rotor has come to stand; every seed is another copy of ESC, motor
-- and bench. How long each takes, and the rise from 2.0 to 3.2 N once it is warm from the rest.
include "include/start.lua"

local function started(t, number)
  t:step("start " .. number)
  t:command { thrust = "2 N" }
  t:within("1 s", function(s) return s.speed_radps > 350 end, "start " .. number .. " turns")
  ends(t, t:record({ "thrust", "speed" }, "600 ms"), 2, "start " .. number .. ", once it turns,")
end

local function stopped(t)
  t:wait "200 ms"
  t:command { stop = true }
  t:within("4 s", function(s) return s.speed_radps < 10 end, "stands again")
  t:wait "100 ms"
end

plan "ten_starts" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", supply = "16.8 V" },
  tags = { "esc" },
  timeout = "60 s",
  run = function(t)
    t:within("3 s", function(s) return s.armed == 1 end, "armed after its zeros")
    for number = 1, 10 do
      started(t, number)
      if number < 10 then stopped(t) end
    end
    t:wait "2 s"
    t:step "rise"
    local rise = t:record({ "thrust", "winding_peak", "bus_peak" }, "1 s", function()
      t:command { thrust = "3.2 N" }
    end)
    t:expect(rise:rise_time "thrust", "thrust rise 2.0 to 3.2 N"):at_most "50 ms"
    ends(t, rise, 3.2, "rise")
    safe(t, rise, "rise")
    t:expect(t:value "shoot_through", "legs shorted"):equal(0)
  end,
}
