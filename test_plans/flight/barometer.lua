-- The barometer's filter (thesis, eq 6.12) against truth: height and climb through climbs and descents, over
-- a minute and a half, while the accelerometer's zero point has gone off by 50 mm/s2 as with temperature: alone
-- it would tell a climb of 4 m/s in the end. The rotors' wash is learned from motion capture beside it; the air
-- itself wanders by 8 Pa (0.7 m) in ten minutes, 0.26 m in a minute and a half.
include "include/hover.lua"

plan "barometer" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "120 s",
  run = function(t)
    hover(t)
    t:fault { kind = "sensor_offset", device = "imu", axis = "accel_z", value = "0.05 m/s2" }
    t:wait "5 s"
    local heights = { 2.2, 0.8, 1.8, 1.1 }
    local whole = t:record({ "baro_height_error", "baro_climb_error", "height" }, "90 s", function()
      for leg, height in ipairs(heights) do
        t:at(12 + 18 * leg .. " s", { position = { height = height .. " m" }, speed = "0.5 m/s" })
      end
    end)
    -- They were flown.
    t:expect(whole:max "height", "highest"):within("2.1 m", "2.3 m")
    t:expect(whole:min "height", "lowest"):within("0.7 m", "0.9 m")
    t:expect(whole:rms "baro_height_error", "height"):at_most "20 cm"
    t:expect(whole:rms "baro_climb_error", "climb"):at_most "0.1 m/s"
    t:expect(whole:max_error("baro_climb_error", "0 m/s"), "climb, at worst"):at_most "0.35 m/s"
  end,
}
