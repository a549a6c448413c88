-- What the flights of five boards share.
escs = { "esc1", "esc2", "esc3", "esc4" }

-- Every flight of the chain ends by what the five have kept of the energy. (Before, the charging of their capacitors is all.)
function chain_plan(name, more, run)
  plan(name) {
    nodes = chain_nodes(more.watch, more.of_escs), wires = chain_wires(), vehicle = "hp_quad",
    tags = more.tags or { "chain", "nightly" }, timeout = more.timeout or "60 s",
    run = function(t)
      run(t)
      if more.energy ~= false then judged_energy(t) end
    end,
  }
end

function heartbeat(t)
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  t:wait "3 s" -- gyro bias on the ground, capture poses, ESC arming zeros
end

-- From reset to a steady hover at 1.1 m.
function hovers(t)
  heartbeat(t)
  t:command { arm = true }
  t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
  t:command { takeoff = "1.1 m" }
  t:within("6 s", function(s) return s.height_m > 1.0 end, "1 m high")
  t:wait "3 s"
end

function lands(t)
  t:step "land"
  t:command { land = true }
  t:within("10 s", function(s) return s.on_ground == 1 end, "on the ground")
  t:within("7 s", function(s) return s.told_armed == 0 end, "disarmed")
end
