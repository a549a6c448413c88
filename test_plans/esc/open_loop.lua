-- What the motor does without any controller: the same step as thrust_rise, by duty alone. The duties that hold
-- 2.0 and 3.2 N are looked for first.
include "include/start.lua"

-- Duty in percent that holds `thrust_N`, by secants from two steady points.
local function duty_for(t, thrust_N, first, second)
  local function thrust_at(duty)
    t:command { duty = string.format("%.3f %%", duty) }
    t:wait "1500 ms"
    return t:value("thrust", "N")
  end
  local a, b = first, second
  local thrust_a, thrust_b = thrust_at(a), thrust_at(b)
  for _ = 1, 5 do
    if math.abs(thrust_b - thrust_N) < 0.01 then break end
    local c = b + (thrust_N - thrust_b) * (b - a) / (thrust_b - thrust_a)
    a, thrust_a, b, thrust_b = b, thrust_b, c, thrust_at(c)
  end
  return b
end

plan "rise_open_loop" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", supply = "16 V", mode = "duty" },
  tags = { "esc" },
  timeout = "60 s",
  run = function(t)
    t:wait "50 ms"
    t:command { line = "mode 0" }
    start(t, { duty = "30 %" })
    t:step "duties"
    local high = duty_for(t, 3.2, 40, 44)
    local low = duty_for(t, 2.0, 30, 34)
    t:log(string.format("2.0 N at %.2f %%, 3.2 N at %.2f %%", low, high))
    t:step "rise"
    t:command { duty = string.format("%.3f %%", low) }
    t:wait "2 s"
    local rise = t:record({ "thrust", "winding_peak" }, "1500 ms", function()
      t:command { duty = string.format("%.3f %%", high) }
    end)
    t:expect(rise:final "thrust", "thrust after the step"):within("3.15 N", "3.25 N")
    t:expect(rise:rise_time "thrust", "thrust rise by duty alone"):within("70 ms", "140 ms")
    t:expect(rise:overshoot "thrust", "overshoot"):at_most "10 %"
    t:step "fall"
    local fall = t:record({ "thrust" }, "1500 ms", function()
      t:command { duty = string.format("%.3f %%", low) }
    end)
    -- No diode brakes: once the duty is below the back-EMF only the air does.
    t:expect(fall:fall_time "thrust", "thrust fall by duty alone"):within("70 ms", "400 ms")
  end,
}
