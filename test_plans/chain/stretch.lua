-- An ESC that holds the clock: after each of its addresses, on its own end of the wire, and so on the whole bus.
include "include/chain.lua"
include "include/flights.lua"

-- A third of what the flight controller waits for a byte (600 us). Who is asked after it is asked that much later each time.
chain_plan("chain has an ESC that stretches", { timeout = "60 s" }, function(t)
  hovers(t)
  t:fault { kind = "i2c_late", bus = "esc2/i2c2", value = "200 us" }
  t:wait "1 s"
  for _, esc in ipairs(escs) do
    t:bus { device = "flight/" .. esc, direction = "write", period = "20 ms", tolerance = "0.5 ms", during = "5 s" }
    t:bus { device = "flight/" .. esc, direction = "read", period = "50 ms", tolerance = "1 ms", during = "5 s" }
  end
  t:latency { from = "flight/imu", through = { "flight/fw::imu_task", "flight/fw::attitude_task" },
              to = "flight/esc", at_most = "7 ms", during = "5 s" }
  local hover = t:record({ "height", "offset", "tilt" }, "5 s")
  t:expect(hover:rms_error("height", "1.1 m"), "height RMS error"):at_most "5 cm"
  t:expect(hover:rms_error("offset", "0 m"), "sideways RMS error"):at_most "10 cm"
  t:expect(hover:max "tilt", "tilt"):at_most "10 deg"
  lands(t)
end)

-- Longer than it is waited for: as an ESC that is not heard any more (faults.lua).
chain_plan("chain gives up an ESC that stretches too long", { timeout = "60 s" }, function(t)
  hovers(t)
  t:fault { kind = "i2c_late", bus = "esc2/i2c2", value = "1 ms" }
  t:wait "500 ms"
  cuts(t, "an ESC is silent", 2)
end)
