-- Sensors that tell what cannot be, in the air: a magnet that comes near, a pressure that leaps or runs away, cameras that
-- take another body for this one. What is not believed moves nobody, and who has no heading comes down.
include "include/gps.lua"
include "include/gps_faults.lua"
include "include/hover.lua"
include "include/moment.lua"

local function outdoors(name, run)
  gps_fault_plan("px4fmu_v1", name, run)
end

-- 20 s by the gyros alone, then it lands while it still knows its heading.
local function comes_down_by_gyro(t, told, limit)
  t:told("3 s", told)
  stays_near(t, limit, "17 s")
  t:expect(t:value "heading_error", "heading"):within("-8 deg", "8 deg")
  lands(t, "heading by gyro for too long", 4, { noticed = "10 s", tilt = "30 deg", down = "40 s", upright = false })
end

for _, f in ipairs {
  { name = "a magnet before it", axis = "field_x", value = "30 uT" },
  { name = "a magnet behind it", axis = "field_x", value = "-60 uT" },
  { name = "a magnet beside it", axis = "field_y", value = "40 uT" },
  { name = "a magnet below it", axis = "field_z", value = "-30 uT" },
} do
  outdoors("by GPS: " .. f.name, function(t)
    hover_by_gps(t)
    some_moment(t)
    t:fault { kind = "sensor_offset", device = "mag", axis = f.axis, value = f.value }
    comes_down_by_gyro(t, "magnetometer silent or out of range", "4 m")
  end)
end

-- Two offsets turn the level field of the ground by 120 degrees: nothing tells, until it moves.
outdoors("by GPS: a heading that is wrong from the start", function(t)
  t:fault { kind = "sensor_offset", device = "mag", axis = "field_x", value = "-38 uT" }
  t:fault { kind = "sensor_offset", device = "mag", axis = "field_y", value = "11 uT" }
  t:always("inside_fence"):at_least(1)
  arm_by_gps(t)
  t:command { takeoff = "6 m" }
  local tilt = t:always "tilt"
  tilt:at_most "40 deg"
  stays_near(t, "10 m", "12 s")
  stays_near(t, "10 m", "5 s")
  t:expect(t:value "heading_error", "heading"):within("-20 deg", "20 deg")
  tilt:stop()
  lands(t, "heading by gyro for too long", 4, { noticed = "15 s", tilt = "30 deg", down = "40 s", upright = false })
end)

for _, f in ipairs {
  { name = "the pressure leaps up", kind = "sensor_offset", value = "2000 Pa", least = "5 m", most = "7 m" },
  { name = "the pressure leaps down", kind = "sensor_offset", value = "-2000 Pa", least = "5 m", most = "7 m" },
  { name = "the pressure leaps by 8 m", kind = "sensor_offset", value = "100 Pa", least = "5 m", most = "7 m" },
  -- 20 Pa a second are a fall by 1.7 m/s; what it has done before it is doubted stays.
  { name = "the pressure runs up", kind = "sensor_drift", value = "1200 Pa", least = "2 m", most = "11 m" },
  { name = "the pressure runs down", kind = "sensor_drift", value = "-1200 Pa", least = "2 m", most = "11 m" },
} do
  outdoors("by GPS: " .. f.name, function(t)
    hover_by_gps(t)
    some_moment(t)
    t:fault { kind = f.kind, device = "baro", axis = "pressure", value = f.value }
    local r = t:record({ "height", "tilt" }, "20 s")
    t:expect(r:min "height", "lowest"):at_least(f.least)
    t:expect(r:max "height", "highest"):at_most(f.most)
    t:expect(t:value "told_state", "flies"):equal(2)
    t:command { land = true }
    t:within("40 s", function(s) return s.on_ground == 1 end, "on the ground")
    t:within("6 s", function(s) return s.told_armed == 0 end, "disarmed")
  end)
end

for _, f in ipairs {
  { name = "cameras that see it 1.5 m further", kind = "capture_moved", value = "1.5 m" },
  { name = "cameras that swap its markers", kind = "capture_turned", value = "90 deg" },
} do
  local function in_the_room(name, run)
    plan(name) {
      image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
      tags = { "flight", "faults" }, timeout = "60 s", run = run,
    }
  end
  in_the_room(f.name .. " for a moment", function(t)
    hover(t)
    some_moment(t)
    t:fault { kind = f.kind, value = f.value, duration = "300 ms" }
    local r = t:record({ "height", "offset", "tilt" }, "4 s")
    t:expect(r:max_error("height", "1.1 m"), "height"):at_most "10 cm"
    t:expect(r:max "offset", "sideways"):at_most "15 cm"
    t:expect(r:max "tilt", "tilt"):at_most "5 deg"
    t:expect(t:value "told_state", "flies"):equal(2)
  end)
  in_the_room(f.name .. " for good", function(t)
    hover(t)
    some_moment(t)
    t:fault { kind = f.kind, value = f.value }
    lands(t, "no position", 4)
  end)
end
