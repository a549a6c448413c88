-- Servo pulses on PA8: armed by low throttle, followed, off within 0.6 s of the last one; what is no pulse is not
-- obeyed, and I2C goes first. Left out: a line that is spoiled in every period for longer than 0.5 s: the motor goes off.
-- Spikes of a valid width: the image looks once a millisecond, by its own crystal, so that each copy looks at other instants
-- of a pulse. A train of 49.9 Hz, 40 us off from one pulse to the next, meets all of them in half a second.
include "include/start.lua"

local function pwm_plan(name, stand, run)
  stand.prop, stand.battery = "hk_10x4.5", "4s_2200"
  plan(name) { image = "esc", board = "esc32v2", stand = stand, tags = { "esc" }, timeout = "30 s", run = run }
end

for _, rate in ipairs { "50 Hz", "400 Hz" } do
  pwm_plan("pwm_flies_" .. rate:gsub(" ", ""), { throttle = "pwm", pulse_rate = rate }, function(t)
    t:step "arming"
    local early = t:record({ "armed" }, "450 ms")
    t:expect(early:max "armed", "armed before 0.5 s of low throttle"):at_most(0)
    start(t, "2 N")
    t:expect(t:value "thrust", "thrust at 2 N"):within("1.9 N", "2.1 N")
    t:command { thrust = "4 N" }
    t:within("150 ms", function(s) return s.thrust_N > 3.8 end, "follows to 4 N")
    t:step "silence"
    t:command { silence = true }
    t:wait "400 ms"
    t:expect(t:value "thrust", "holds on for 0.4 s"):at_least "3.8 N"
    t:wait "200 ms"
    local off = t:record({ "winding_peak" }, "1 s")
    t:expect(off:max "winding_peak", "winding current from 0.6 s on"):at_most "0.1 A"
    t:expect(t:value "armed", "disarmed"):equal(0)
    t:step "pulses again, throttle up"
    t:command { silence = false }
    local still = t:record({ "winding_peak" }, "1 s")
    t:expect(still:max "winding_peak", "high throttle alone starts nothing"):at_most "0.1 A"
  end)
end

pwm_plan("pwm_high_throttle_at_power_up", { throttle = "pwm" }, function(t)
  t:command { thrust = "2 N" }
  local still = t:record({ "winding_peak", "armed" }, "3 s")
  t:expect(still:max "winding_peak", "winding current"):at_most "0.1 A"
  t:expect(still:max "armed", "armed"):equal(0)
end)

-- 1500 us are 4.19 N; each train lasts for a while, then good pulses come again.
local function ignored(t, words, train, duration)
  t:step(words)
  local record = t:record({ "thrust" }, duration or "300 ms", function() t:command { pulses = train } end)
  t:expect(record:max "thrust", "highest thrust, " .. words):at_most "4.5 N"
  t:expect(record:min "thrust", "lowest thrust, " .. words):at_least "3.9 N"
  t:command { pulses = { width = "1500 us" } }
  t:wait "300 ms"
end

pwm_plan("pwm_glitches", { throttle = "pwm" }, function(t)
  start(t, "2 N")
  t:command { pulses = { width = "1500 us" } }
  t:wait "500 ms"
  t:expect(t:value "thrust", "thrust at 1500 us"):within("4.0 N", "4.4 N")
  ignored(t, "too short", { width = "850 us" })
  ignored(t, "too long", { width = "2150 us" })
  ignored(t, "spikes of 5 us", { width = "1500 us", glitch = "5 us", glitch_after = "700 us" }, "1 s")
  ignored(t, "cut in two", { width = "1900 us", glitch = "50 us", glitch_after = "600 us" })
  ignored(t, "spikes of 100 us between", { width = "1500 us", glitch = "100 us", glitch_after = "9 ms" })
  ignored(t, "spikes of 950 us between", { width = "1500 us", glitch = "950 us", glitch_after = "9 ms" })
  ignored(t, "spikes of 950 us, wherever it looks", { width = "1500 us", rate = "49.9 Hz", glitch = "950 us", glitch_after = "9 ms" }, "1 s")
  ignored(t, "far too fast", { width = "300 us", rate = "2000 Hz" })
  ignored(t, "too fast", { width = "1200 us", rate = "600 Hz" })
  ignored(t, "too slow", { width = "1900 us", rate = "30 Hz" })
  ignored(t, "slower than the timer's range", { width = "1900 us", rate = "12 Hz" })
  t:expect(t:value "armed", "still armed"):equal(1)
  t:step "nothing but spoiled pulses"
  t:command { pulses = { width = "850 us" } }
  t:wait "600 ms"
  local off = t:record({ "winding_peak" }, "500 ms")
  t:expect(off:max "winding_peak", "winding current from 0.6 s on"):at_most "0.1 A"
  t:expect(t:value "armed", "disarmed"):equal(0)
end)

pwm_plan("pwm_beside_i2c", {}, function(t)
  t:command { pulses = { width = "1000 us" } }
  start(t, "2 N")
  t:step "pulses beside set-points"
  local record = t:record({ "thrust" }, "1 s", function() t:command { pulses = { width = "1900 us" } } end)
  t:expect(record:max "thrust", "highest thrust"):at_most "2.1 N"
  t:step "set-points end"
  t:command { silence = true }
  local coast = t:record({ "thrust" }, "1500 ms")
  t:expect(coast:max "thrust", "high throttle does not take over"):at_most "2.1 N"
  t:expect(t:value "armed", "disarmed"):equal(0)
  t:step "low throttle arms"
  t:command { pulses = { width = "1000 us" } }
  t:within("1 s", function(s) return s.armed == 1 end, "armed by pulses")
  t:command { pulses = { width = "1500 us" } }
  t:within("2 s", function(s) return s.thrust_N > 3.9 end, "flies by pulses")
  t:step "set-points of I2C while pulses fly"
  t:command { silence = false, stop = true }
  local flies = t:record({ "thrust" }, "1 s")
  t:expect(flies:min "thrust", "lowest thrust"):at_least "3.9 N"
  t:step "the same width from the terminal"
  t:ask("pwm 850", "^refused$")
  t:ask("pwm 1500", "^ok$")
end)
