-- What the flights of five boards share.
escs = { "esc1", "esc2", "esc3", "esc4" }

-- Every flight of the chain ends by what the five have kept of the energy. (Before, the charging of their capacitors is all.)
-- `can`: the five are joined on CAN. `parity`: the same is also flown by the flight controller alone, with the control core of the ESCs on the host, as all
-- other flights are; `whirl parity` lays the two side by side. `run` is told whether the controllers are boards.
function chain_plan(name, more, run)
  plan(name) {
    nodes = chain_nodes(more.watch, more.of_escs, more.can), wires = chain_wires(more.can), vehicle = more.vehicle or "hp_quad",
    tags = more.tags or { "chain", "nightly" }, timeout = more.timeout or "60 s",
    run = function(t)
      run(t, true)
      if more.energy ~= false then judged_energy(t) end
    end,
  }
  if not more.parity then return end
  plan(name .. ", native controllers") {
    nodes = { chain_nodes(more.watch, nil, more.can)[1] }, vehicle = more.vehicle or "hp_quad",
    tags = { "parity" }, timeout = more.timeout or "60 s", run = function(t) run(t, false) end,
  }
end

function heartbeat(t)
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  t:wait "3 s" -- gyro bias on the ground, capture poses, ESC arming zeros
end

-- Of five that a CAN joins: the flight image is told so.
function heartbeat_on_can(t)
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  t:command { parameter = { name = "ESC_BUS", value = 1 } }
  t:within("3 s", function(s) return s.parameter_pending == 0 end, "ESC_BUS is answered")
  t:expect(t:value "parameter_result", "ESC_BUS is taken over"):equal(0)
  t:wait "3 s"
end

-- From reset to a steady hover at 1.1 m; `climbs`: the time that it has to 1 m.
function hovers(t, climbs)
  heartbeat(t)
  t:command { arm = true }
  t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
  t:command { takeoff = "1.1 m" }
  t:within(climbs or "6 s", function(s) return s.height_m > 1.0 end, "1 m high")
  t:wait "3 s"
end

-- Whether that signal of each rotor is at most so much; of the lost one it may be more.
function each_rotor(s, before, after, most, lost)
  for motor = 1, 4 do
    if motor ~= lost and s[before .. motor .. after] > most then return false end
  end
  return true
end

function no_rotor_is_driven(s, lost) return each_rotor(s, "winding_current_", "_A", 0.5, lost) end

function lands(t)
  t:step "land"
  t:command { land = true }
  t:within("10 s", function(s) return s.on_ground == 1 end, "on the ground")
  t:within("7 s", function(s) return s.told_armed == 0 end, "disarmed")
end

-- No rotor but the lost one's is driven any more 100 ms after it is known, as test_plans/flight/fail_safes.lua has it,
-- and it ends on the ground.
function cuts(t, words, lost)
  t:within("100 ms", function(s) return no_rotor_is_driven(s, lost) end, "no other rotor is driven")
  local currents = {}
  for motor = 1, 4 do
    if motor ~= lost then currents[#currents + 1] = "winding_current_" .. motor end
  end
  local after = t:record(currents, "500 ms")
  for _, current in ipairs(currents) do t:expect(after:max(current), current .. " from then on"):at_most "0.5 A" end
  t:told("3 s", words)
  t:within("30 s", function(s) return s.told_armed == 0 and s.on_ground == 1 end, "on the ground, disarmed")
  t:wait "1 s"
  for motor = 1, 4 do t:expect(t:value("speed_" .. motor), "speed of rotor " .. motor):at_most "5 rad/s" end
end
