-- A board that is pulled out and put back, standing and in the air: it has no supply meanwhile and is on no wire, and starts
-- as from power-up when it is back.
include "include/chain.lua"
include "include/flights.lua"

local function answers_again(t)
  t:wait "1 s"
  for _, esc in ipairs(escs) do
    t:bus { device = "flight/" .. esc, direction = "read", period = "50 ms", tolerance = "1 ms", during = "1 s" }
  end
  t:wait "1.5 s"
end

chain_plan("chain has an ESC unplugged and plugged in on the ground", { timeout = "40 s", energy = false }, function(t)
  heartbeat(t)
  t:fault { kind = "board_unplugged", node = "esc2", duration = "1 s" }
  t:wait "1 s"
  answers_again(t)
  t:command { arm = true }
  t:within("3 s", function(s) return s.told_armed == 1 end, "armed")
  t:within("2 s", function(s) return math.min(s.speed_1_radps, s.speed_2_radps, s.speed_3_radps, s.speed_4_radps) > 50 end,
           "all four rotors idle")
end)

-- Back before its silence would be told (0.5 s), it is known by its motor that stands.

chain_plan("chain has an ESC unplugged and plugged in in the air", { timeout = "60 s" }, function(t)
  hovers(t)
  t:fault { kind = "board_unplugged", node = "esc2", duration = "400 ms" }
  t:wait "400 ms"
  cuts(t, "a motor has stopped", 2)
  answers_again(t)
end)
