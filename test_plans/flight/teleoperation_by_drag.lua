-- Teleoperation by velocities (thesis, Fig 6.10): motion capture is lost after 100 s of flight, and for 60 s more
-- the vehicle flies on by drag: velocity through the air and the wind as capture had taught it, height by the
-- barometer, heading by the magnetic field. Position is no longer known: how far it drifts is told. Then it lands.
include "include/hover.lua"
include "include/parameter.lua"

local ways = { { "0.6 m/s", "0 m/s" }, { "-0.6 m/s", "0 m/s" }, { "0 m/s", "0.6 m/s" }, { "0 m/s", "-0.6 m/s" },
               { "0.4 m/s", "0.4 m/s" }, { "-0.4 m/s", "-0.4 m/s" } }
local signals = { "velocity_north", "velocity_east", "height", "told_height", "tilt", "velocity_error_north", "velocity_error_east" }

-- Flies the ways, five seconds each, for a time; judges each from when it has been flown up to.
local function teleoperate(t, legs, words, by_drag)
  for leg = 1, legs do
    local way = ways[(leg - 1) % #ways + 1]
    t:command { velocity = { north = way[1], east = way[2] } }
    t:wait "2 s"
    local r = t:record(signals, "3 s")
    local name = words .. ", leg " .. leg
    t:expect(r:max_error { velocity_north = way[1], velocity_east = way[2] }, name .. ": velocity off the command"):at_most "0.3 m/s"
    t:expect(r:rms_error { velocity_error_north = "0 m/s", velocity_error_east = "0 m/s" }, name .. ": velocity believed, RMS error"):at_most "0.15 m/s"
    -- Held is the barometer's height. Where that is nobody but capture can tell: it wanders by 8 Pa in 10 minutes
    -- (plant/sensors), 0.3 m in a minute, in one standard deviation; three of them are told apart from a fault.
    t:expect(r:max_error("told_height", "1.1 m"), name .. ": height, by the vehicle's own"):at_most "0.3 m"
    t:expect(r:max_error("height", "1.1 m"), name .. ": height"):at_most(by_drag and "1.2 m" or "0.3 m")
  end
end

local function teleoperation(name, wind)
  plan("teleoperation by drag" .. name) {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
    room = { size = { "100 m", "100 m", "20 m" } },
    tags = { "nightly" }, timeout = "220 s",
    run = function(t)
      t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "it is up")
      set_parameter(t, "FENCE_NORTH", 50)
      set_parameter(t, "FENCE_EAST", 50)
      hover(t)
      if wind then t:gust { north = "1.5 m/s", east = "1 m/s", duration = "200 s", edge = "3 s" } end
      t:always("tilt"):at_most "15 deg"
      t:wait "10 s"
      t:step "by velocities, with capture"
      teleoperate(t, 18, "with capture")
      t:step "capture lost"
      t:fault { kind = "capture_lost" }
      teleoperate(t, 12, "by drag", true)
      t:expect(t:value "told_velocity_source", "by drag until now"):equal(2)
      local north = t:value("told_north").value - t:value("north").value
      local east = t:value("told_east").value - t:value("east").value
      t:expect(math.sqrt(north * north + east * east), "drift of the position, in metres"):at_most(12)
      t:expect(t:value "told_state", "flies"):equal(2)
      t:step "and lands"
      t:within("30 s", function(s) return s.told_state == 0 end, "landed")
    end,
  }
end

teleoperation("", false)
teleoperation(" in wind", true)
