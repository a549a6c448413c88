-- Five boards that do not start together: each order ends in a vehicle that can be armed, and nothing turns before. And
-- five that lose their supply at once, standing with idling rotors and in the air.
include "include/chain.lua"
include "include/flights.lua"

local nodes = { "flight", "esc1", "esc2", "esc3", "esc4" }

local function no_rotor_moves(t)
  local still = {}
  for motor = 1, 4 do
    still[motor] = t:always("speed_" .. motor)
    still[motor]:within("-1 rad/s", "1 rad/s")
  end
  return function()
    for motor = 1, 4 do still[motor]:stop() end
  end
end

local function arms_and_idles(t)
  t:command { arm = true }
  t:within("3 s", function(s) return s.told_armed == 1 end, "armed")
  t:within("2 s", function(s) return math.min(s.speed_1_radps, s.speed_2_radps, s.speed_3_radps, s.speed_4_radps) > 50 end,
           "all four rotors idle")
end

local function polls(t)
  for _, esc in ipairs(escs) do
    t:bus { device = "flight/" .. esc, direction = "read", period = "50 ms", tolerance = "1 ms", during = "1 s" }
  end
end

-- From its start on, whatever it was before.
local function comes_up(t)
  local moved = no_rotor_moves(t)
  t:wait "1 s"
  polls(t)
  t:within("7 s", function(s) return s.heartbeat_age_s < 1.5 and s.told_ready == 1 end, "it says that it can be armed")
  t:wait "1 s"
  moved()
end

local function all_reset(t)
  t:fault { kind = "supply_dip", value = "9 V", duration = "100 ms" }
  for _, node in ipairs(nodes) do t:fault { kind = "reset_pin", node = node } end
end

-- NRST of each, at these times: the part that is reset last is the last that is there.
local orders = {
  { "the flight controller first", flight = 100, esc1 = 400, esc2 = 900, esc3 = 1400, esc4 = 2000 },
  { "the flight controller last", flight = 2000, esc1 = 100, esc2 = 400, esc3 = 900, esc4 = 1400 },
  { "the flight controller between", flight = 903, esc1 = 2000, esc2 = 400, esc3 = 100, esc4 = 1400 },
}
for _, order in ipairs(orders) do
  chain_plan("chain starts, " .. order[1], { timeout = "30 s", energy = false }, function(t)
    for _, node in ipairs(nodes) do
      t:fault { kind = "reset_pin", node = node, start = order[node] .. " ms" }
    end
    local moved = no_rotor_moves(t)
    t:wait "2.1 s"
    moved()
    comes_up(t)
    arms_and_idles(t)
  end)
end

chain_plan("chain browns out on the ground", { timeout = "60 s", energy = false }, function(t)
  heartbeat(t)
  arms_and_idles(t)
  all_reset(t)
  t:within("100 ms", no_rotor_is_driven, "no rotor is driven")
  t:within("5 s", function(s) return s.told_armed == 0 end, "told as disarmed")
  t:within("5 s", function(s) return math.max(s.speed_1_radps, s.speed_2_radps, s.speed_3_radps, s.speed_4_radps) < 1 end,
           "the rotors stand")
  comes_up(t)
  arms_and_idles(t)
end)

-- What nothing on board remembers, it does not do again.
chain_plan("chain browns out in the air", { timeout = "60 s", energy = false }, function(t)
  hovers(t)
  all_reset(t)
  t:wait "100 ms"
  local currents = { "winding_current_1", "winding_current_2", "winding_current_3", "winding_current_4" }
  local fall = t:record(currents, "5 s")
  for _, current in ipairs(currents) do t:expect(fall:max(current), current .. " from then on"):at_most "0.5 A" end
  t:within("5 s", function(s) return s.told_armed == 0 and s.on_ground == 1 end, "on the ground, disarmed")
  for motor = 1, 4 do t:expect(t:value("speed_" .. motor), "speed of rotor " .. motor):at_most "5 rad/s" end
end)
