-- What goes wrong between five boards: one ESC that is not heard any more, one that starts anew in the air, a bus that
-- a slave holds until nine clocks have passed, with four real slaves on it.
include "include/chain.lua"
include "include/flights.lua"

-- It turns on until its own time-out for set-points has passed.
chain_plan("chain loses an ESC's bus", { timeout = "60 s" }, function(t)
  hovers(t)
  t:fault { kind = "i2c_nack", device = "flight/esc3" }
  t:wait "500 ms"
  cuts(t, "an ESC is silent", 3)
end)

-- Its image starts from its vectors and wants zeros before it drives again, which a flight does not send.
for motor = 1, 4 do
  chain_plan("chain has ESC " .. motor .. " reset in the air", { timeout = "60 s" }, function(t)
    hovers(t)
    t:wait(t:drawn("0 s", "200 ms"))
    t:fault { kind = "reset_pin", node = "esc" .. motor }
    cuts(t, "a motor has stopped", motor)
  end)
end

chain_plan("chain frees a bus that is stuck", { timeout = "60 s" }, function(t)
  hovers(t)
  local r = t:record({ "height", "offset", "tilt" }, "3 s", function()
    t:fault { kind = "i2c_stuck_sda", bus = "flight/i2c3", duration = "400 ms", value = 9 }
  end)
  t:expect(r:max "height", "highest"):at_most "1.2 m"
  t:expect(r:min "height", "lowest"):at_least "1.0 m"
  t:expect(r:max "tilt", "tilt"):at_most "10 deg"
  t:expect(r:max "offset", "sideways"):at_most "20 cm"
  for _, esc in ipairs(escs) do
    t:bus { device = "flight/" .. esc, direction = "read", period = "50 ms", tolerance = "1 ms", during = "1 s" }
  end
  t:wait "1 s"
  lands(t)
end)
