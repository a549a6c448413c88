-- From the supply to ready: five boards start at once, each at its own pace. The ESCs answer the flight controller's
-- polls before it can be armed, and no rotor moves until then.
include "include/chain.lua"
include "include/flights.lua"

chain_plan("chain boot", { timeout = "20 s", energy = false }, function(t)
  local still = {}
  for motor = 1, 4 do
    still[motor] = t:always("speed_" .. motor)
    still[motor]:within("-1 rad/s", "1 rad/s")
  end
  t:within("500 ms", function(s) return s.heartbeat_age_s < 1 end, "the first heartbeat")
  for _, esc in ipairs(escs) do
    t:bus { device = "flight/" .. esc, direction = "read", period = "50 ms", tolerance = "1 ms", during = "1 s" }
  end
  t:within("6 s", function(s) return s.told_ready == 1 end, "it says that it can be armed")
  for motor = 1, 4 do still[motor]:stop() end
  t:command { arm = true }
  t:within("3 s", function(s) return s.told_armed == 1 end, "armed")
  t:within("2 s", function(s) return s.speed_1_radps > 50 and s.speed_2_radps > 50 and s.speed_3_radps > 50 and s.speed_4_radps > 50 end,
           "all four rotors idle")
end)
