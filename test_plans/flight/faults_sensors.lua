-- Faults of the barometer, of the magnetometer and of their bus, most for two seconds in mid-hover. The capture
-- system is there: the vehicle flies on as if nothing had been, and what the parts tell is back soon after.
include "include/hover.lua"
include "include/sensor_fault.lua"

local faults = {
  { name = "the barometer answers nothing", kind = "i2c_nack", device = "baro" },
  { name = "the barometer's data stay", kind = "sensor_frozen", device = "baro" },
  { name = "the barometer reads 50 Pa more", kind = "sensor_offset", device = "baro", axis = "pressure", value = "50 Pa",
    baro = "4.8 m" }, -- 4.2 m of it
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
      judged_sensor_fault(t, f)
    end,
  }
end
