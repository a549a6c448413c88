-- How every fail-safe ends, the same in each plan that has one. It says why. Where attitude is known it comes down under control,
-- at less than 2 m/s; where nothing can be controlled no rotor is driven any more 100 ms after the fault, and it falls where
-- ballistics leave it. Either way it ends on the ground, within the fence, disarmed, rotors at rest.
-- told_state: 0 disarmed, 2 flying, 3 landing, 4 failsafe landing.

-- `how.upright = false`: it may lie on its side.
function ends_on_the_ground(t, how)
  t:within("30 s", function(s) return s.told_armed == 0 and s.on_ground == 1 end, "on the ground, disarmed")
  -- None is driven; one of little friction runs down for two seconds, longer than the next heartbeat takes.
  t:within("3 s", function(s)
    for motor = 1, 4 do
      if math.abs(s["speed_" .. motor .. "_radps"]) > 5 then return false end
    end
    return true
  end, "rotors at rest")
  t:expect(t:value "inside_fence", "within the fence"):equal(1)
  if how.upright ~= false then t:expect(t:value "tilt", "tilt on the ground"):at_most "5 deg" end
end

-- Right after the fault: it comes down under control. Who stands is off in 0.8 s, of which the next heartbeat tells within 1.1, or if
-- it is lost in 2.1. What rocks or hops on its feet in the wind takes up to 1.5 s (firmware/tests/touchdown_test.cpp), and a
-- gust may throw it once more: 6 s.
-- how: `noticed` within that time it says that it lands (7.1 s), `tilt` at most (20 deg), `down` within that time (30 s), `outside`:
-- the fault is that it left the fence, `upright` as above.
function lands(t, words, state, how)
  how = how or {}
  local kept = { t:always "climb", t:always "tilt" }
  kept[1]:at_least "-2 m/s"
  kept[2]:at_most(how.tilt or "20 deg")
  if not how.outside then
    kept[3] = t:always "inside_fence"
    kept[3]:at_least(1)
  end
  t:within(how.noticed or "7.1 s", function(s) return s.told_state == state end, "told_state " .. state)
  t:told("1.1 s", words)
  t:within(how.down or "30 s", function(s) return s.on_ground == 1 end, "touches the ground")
  kept[1]:stop()
  kept[2]:stop()
  t:within("6 s", function(s) return s.told_armed == 0 end, "disarmed")
  ends_on_the_ground(t, how)
  if kept[3] then kept[3]:stop() end
end

-- Right after the fault: nothing can be controlled, and the motors are cut within 100 ms.
-- how: `noticed` what goes by until it can be known, before the 100 ms (0 s); `driven` the motor whose own ESC is out of reach.
function cuts(t, words, how)
  how = how or {}
  if how.noticed then t:wait(how.noticed) end
  local motors, currents = {}, {}
  for motor = 1, 4 do
    if motor ~= how.driven then
      motors[#motors + 1] = "winding_current_" .. motor .. "_A"
      currents[#currents + 1] = "winding_current_" .. motor
    end
  end
  t:within("100 ms", function(s)
    for _, motor in ipairs(motors) do
      if s[motor] > 0.5 then return false end
    end
    return true
  end, "no rotor is driven")
  local after = t:record(currents, "500 ms")
  for _, current in ipairs(currents) do t:expect(after:max(current), current .. " from then on"):at_most "0.5 A" end
  t:told("3 s", words)
  ends_on_the_ground(t, { upright = false })
end
