-- Faults of the barometer, of the magnetometer and of their bus, most for two seconds in mid-hover. The capture
-- system is there: the vehicle flies on as if nothing had been, and what the parts tell is back soon after.
include "include/hover.lua"

local faults = {
  { name = "the barometer answers nothing", kind = "i2c_nack", device = "baro" },
  { name = "the barometer's data stay", kind = "sensor_frozen", device = "baro" },
  { name = "the barometer reads 50 Pa more", kind = "sensor_offset", device = "baro", axis = "pressure", value = "50 Pa" },
  { name = "the barometer reads 2000 Pa more", kind = "sensor_offset", device = "baro", axis = "pressure", value = "2000 Pa",
    duration = "500 ms" }, -- after a second it would be believed
  { name = "the barometer's conversions take 5 ms more", kind = "sensor_late", device = "baro", value = "5 ms" },
  { name = "the barometer is seen by nobody", kind = "i2c_silence", device = "baro" },
  { name = "the barometer's supply fails", kind = "sensor_brown_out", device = "baro" },
  { name = "the magnetometer's supply fails", kind = "sensor_brown_out", device = "mag" },
  { name = "the magnetometer answers nothing", kind = "i2c_nack", device = "mag" },
  { name = "the magnetometer's data stay", kind = "sensor_frozen", device = "mag" },
  { name = "the magnetometer reads 30 uT more", kind = "sensor_offset", device = "mag", axis = "field_x", value = "30 uT" },
  { name = "the magnetometer overflows", kind = "sensor_saturated", device = "mag", axis = "field_y" },
  { name = "a bit of the sensors' bus is flipped", kind = "i2c_flip_bit", bus = "i2c2", value = "13" },
  { name = "SDA of the sensors' bus is stuck", kind = "i2c_stuck_sda", bus = "i2c2" },
  { name = "SCL of the sensors' bus is stuck", kind = "i2c_stuck_scl", bus = "i2c2" },
}

for _, f in ipairs(faults) do
  plan(f.name) {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
    tags = { "flight", "faults" }, timeout = "60 s",
    run = function(t)
      hover(t)
      t:budget("fw::imu_task") { period = "1 ms", jitter = "20 us", during = "3 s" }
      t:bus { device = "esc1", direction = "write", period = "20 ms", tolerance = "0.5 ms", during = "3 s" }
      t:fault { kind = f.kind, device = f.device, bus = f.bus, axis = f.axis, value = f.value, duration = f.duration or "2 s" }
      local r = t:record({ "height", "offset", "attitude_error" }, "4 s")
      t:expect(r:rms_error("height", "1.1 m"), "height RMS error"):at_most "5 cm"
      t:expect(r:rms "offset", "sideways RMS error"):at_most "10 cm"
      t:expect(r:max "attitude_error", "attitude that is flown by"):at_most "3 deg"
      t:wait "8 s"
      local after = t:record({ "baro_height_error", "baro_climb_error", "attitude_error_1" }, "2 s")
      t:expect(after:rms "baro_height_error", "after 10 s: height by the barometer"):at_most "20 cm"
      t:expect(after:rms "baro_climb_error", "after 10 s: climb by the barometer"):at_most "0.15 m/s"
      t:expect(after:rms "attitude_error_1", "after 10 s: attitude of filter 1"):at_most "3 deg"
    end,
  }
end
