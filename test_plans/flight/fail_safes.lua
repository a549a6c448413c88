-- What the flight image does about each thing that can go wrong, at a moment that the seed draws: the table
-- kRules of firmware/flight/supervisor.hpp, flown. Each ends as include/fail_safe.lua says.
include "include/fail_safe.lua"
include "include/hover.lua"
include "include/moment.lua"

local function fail_safe(name, more, run)
  plan(name) {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
    tags = { "flight", "fail_safe" }, timeout = "90 s",
    room = more.room, fence = more.room and { size = { "5 m", "4 m", "3 m" } },
    run = function(t)
      hover(t)
      some_moment(t)
      run(t)
    end,
  }
end

fail_safe("the capture is lost", {}, function(t)
  t:fault { kind = "capture_lost" }
  lands(t, "no position", 4)
end)

-- It sends on, but what it sent last: in a room without wind, too, the vehicle does not stay there by itself.
fail_safe("the capture stays the same", {}, function(t)
  t:fault { kind = "capture_frozen" }
  lands(t, "no position", 4)
end)

fail_safe("the capture and the barometer are lost", {}, function(t)
  t:fault { kind = "capture_lost" }
  t:fault { kind = "i2c_nack", device = "baro" }
  lands(t, "no position", 4)
end)

fail_safe("the capture comes back on the way down", {}, function(t)
  t:fault { kind = "capture_lost", duration = "1.5 s" }
  lands(t, "no position", 4)
end)

fail_safe("the radio falls silent", {}, function(t)
  t:fault { kind = "uart_silence", device = "radio" }
  lands(t, "no position", 4)
end)

fail_safe("the battery is low", {}, function(t)
  t:fault { kind = "supply_dip", value = "2.6 V" }
  lands(t, "battery low", 3)
end)

fail_safe("the battery is empty", {}, function(t)
  t:fault { kind = "supply_dip", value = "3.4 V" }
  lands(t, "battery empty", 4)
end)

fail_safe("the wire that measures the battery is off", {}, function(t)
  t:fault { kind = "sensor_offset", device = "battery", value = "-20 V" }
  lands(t, "battery empty", 4)
end)

-- The cameras see beyond the fence.
fail_safe("a gust blows it over the fence", { room = { size = { "10 m", "4 m", "3 m" } } }, function(t)
  t:command { position = { north = "2.1 m", height = "1.1 m" } }
  t:wait "5 s"
  t:gust { north = "7 m/s", duration = "1.2 s" }
  lands(t, "outside the fence", 4, { tilt = "30 deg", outside = true })
end)

fail_safe("the IMU freezes", {}, function(t)
  t:fault { kind = "sensor_frozen", device = "imu" }
  cuts(t, "IMU samples are frozen")
end)

fail_safe("the IMU leaves its bus", {}, function(t)
  t:fault { kind = "spi_silent", device = "imu" }
  cuts(t, "IMU gives no samples")
end)

for motor = 1, 4 do
  fail_safe("motor " .. motor .. " stops", {}, function(t)
    t:fault { kind = "esc_stopped", motor = motor }
    cuts(t, "a motor has stopped", { driven = motor })
  end)
end

-- What its ESC bears is flown on with; beyond 22 A, in the mean of 10 ms, it trips by itself.
for motor = 1, 4 do
  fail_safe("motor " .. motor .. " takes too much current", {}, function(t)
    t:fault { kind = "winding_short", motor = motor, value = "10 A", duration = "1 s" }
    local borne = t:record({ "told_state", "bus_current_" .. motor }, "1 s")
    t:expect(borne:max "told_state", "10 A more: it flies on"):at_most(2)
    t:expect(borne:max("bus_current_" .. motor), "10 A more: of the bus"):at_least "11 A"
    t:fault { kind = "winding_short", motor = motor, value = "30 A" }
    cuts(t, "an ESC had too much current", { driven = motor })
  end)
end

-- It turns on for as long as its ESC does without set-points.
fail_safe("an ESC falls silent", {}, function(t)
  t:fault { kind = "i2c_nack", device = "esc3" }
  cuts(t, "an ESC is silent", { noticed = "500 ms", driven = 3 })
end)

-- What takes nothing away is told, and flown on with.
for _, f in ipairs { { "baro", "barometer silent" }, { "mag", "magnetometer silent" } } do
  plan("the " .. f[1] .. " falls silent and is told of") {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
    tags = { "flight", "fail_safe" }, timeout = "60 s",
    run = function(t)
      hover(t)
      some_moment(t)
      t:fault { kind = "i2c_nack", device = f[1] }
      t:told("3 s", f[2])
      local r = t:record({ "height", "offset" }, "4 s")
      t:expect(r:rms_error("height", "1.1 m"), "height RMS error"):at_most "5 cm"
      t:expect(r:rms "offset", "sideways RMS error"):at_most "10 cm"
      t:expect(t:value "told_state", "still flying"):equal(2)
    end,
  }
end

-- What it does not arm with, and says why.
local refusals = {
  { "no capture", { kind = "capture_lost" }, "no position" },
  { "no barometer", { kind = "i2c_nack", device = "baro" }, "barometer silent" },
  { "no magnetometer", { kind = "i2c_nack", device = "mag" }, "magnetometer silent" },
  { "an iron floor", nil, "magnetometer silent or out of range", magnet = true },
  { "a tired battery", { kind = "supply_dip", value = "2.5 V" }, "battery low" },
  { "an ESC that is off", { kind = "i2c_nack", device = "esc2" }, "an ESC is silent" },
}
for _, r in ipairs(refusals) do
  plan("does not arm with " .. r[1]) {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
    tags = { "flight", "fail_safe" }, timeout = "30 s",
    run = function(t)
      if r[2] then t:fault(r[2]) end
      if r.magnet then t:gust { magnet = { field = { north = "150 uT" } } } end
      t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
      t:wait "6 s"
      local armed = t:always("told_armed")
      armed:at_most(0)
      t:command { arm = true }
      t:told("2 s", r[3])
      t:within("2 s", function(s) return s.command_result == 1 end, "refused for the time being")
      armed:stop()
    end,
  }
end
