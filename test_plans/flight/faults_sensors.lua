-- Faults of the barometer, of the magnetometer and of their bus, most for two seconds in mid-hover. The capture
-- system is there: the vehicle flies on as if nothing had been, and what the parts tell is back soon after.
include "include/hover.lua"
include "include/moment.lua"
include "include/sensor_fault.lua"

local faults = {
  { name = "the barometer answers nothing", kind = "i2c_nack", device = "baro" },
  { name = "the barometer's data stay", kind = "sensor_frozen", device = "baro" },
  { name = "the barometer reads 50 Pa more", kind = "sensor_offset", device = "baro", axis = "pressure", value = "50 Pa",
    baro = "4.8 m" }, -- 4.2 m of it
  { name = "the barometer reads 2000 Pa more", kind = "sensor_offset", device = "baro", axis = "pressure", value = "2000 Pa",
    duration = "500 ms" }, -- after a second it would be believed
  { name = "the barometer's thermometer reads 0.3 K more", kind = "sensor_offset", device = "baro", axis = "temperature", value = "0.3 K",
    baro = "6 m" }, -- by the data sheet's typical PROM 1.5 hPa of compensation for each kelvin: 3.7 m
  { name = "the barometer's thermometer overflows", kind = "sensor_saturated", device = "baro", axis = "temperature" },
  { name = "the barometer holds its clock for 200 us", kind = "i2c_late", device = "baro", value = "200 us" },
  { name = "the barometer overflows", kind = "sensor_saturated", device = "baro", axis = "pressure" },
  { name = "the barometer's conversions take 5 ms more", kind = "sensor_late", device = "baro", value = "5 ms" },
  { name = "the barometer is seen by nobody", kind = "i2c_silence", device = "baro" },
  { name = "the barometer's supply fails", kind = "sensor_brown_out", device = "baro" },
  { name = "the magnetometer's supply fails", kind = "sensor_brown_out", device = "mag" },
  { name = "the magnetometer answers nothing", kind = "i2c_nack", device = "mag" },
  { name = "the magnetometer's data stay", kind = "sensor_frozen", device = "mag" },
  { name = "the magnetometer reads 30 uT more", kind = "sensor_offset", device = "mag", axis = "field_x", value = "30 uT" },
  { name = "the magnetometer overflows", kind = "sensor_saturated", device = "mag", axis = "field_y" },
  { name = "the magnetometer's measurements take 5 ms more", kind = "sensor_late", device = "mag", value = "5 ms" },
  { name = "the magnetometer holds its clock for 200 us", kind = "i2c_late", device = "mag", value = "200 us" },
  { name = "the magnetometer is seen by nobody", kind = "i2c_silence", device = "mag" },
  { name = "the gyro reads 1 degree per second more", kind = "sensor_offset", device = "imu", axis = "gyro_y", value = "1 deg/s" },
  { name = "the gyro reads 3 % more", kind = "sensor_scale", device = "imu", axis = "gyro_y", value = "3 %" },
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
      some_moment(t)
      t:budget("fw::imu_task") { period = "1 ms", jitter = "20 us", during = "3 s", margin = "10 %" }
      t:bus { device = "esc1", direction = "write", period = "20 ms", tolerance = "0.5 ms", during = "3 s" }
      judged_sensor_fault(t, f)
    end,
  }
end

-- As parts do that warm up: 0.16 deg/s a kelvin of the gyro, 1 mg a kelvin of the accelerometer, 20 kelvin a minute; height by 5 m,
-- and by a thermometer that lags 0.3 K a minute behind, field by a sixth.
plan "sensors that drift are flown with" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight", "faults" }, timeout = "60 s",
  run = function(t)
    hover(t)
    t:fault { kind = "sensor_drift", device = "imu", axis = "gyro_y", value = "3 deg/s" }
    t:fault { kind = "sensor_drift", device = "imu", axis = "accel_x", value = "0.2 m/s2" }
    t:fault { kind = "sensor_drift", device = "baro", axis = "pressure", value = "60 Pa" }
    t:fault { kind = "sensor_drift", device = "baro", axis = "temperature", value = "0.3 K" }
    t:fault { kind = "sensor_drift", device = "mag", axis = "field_x", value = "10 uT" }
    local r = t:record({ "height", "offset", "attitude_error" }, "25 s")
    t:expect(r:rms_error("height", "1.1 m"), "height RMS error"):at_most "5 cm"
    t:expect(r:rms "offset", "sideways RMS error"):at_most "10 cm"
    t:expect(r:max "attitude_error", "attitude that is flown by"):at_most "3 deg"
    t:expect(t:value "told_state", "flies"):equal(2)
  end,
}

-- A part that is not what the image was built for, from power-up on. The barometer's is one of the four bits that check its
-- PROM, turned over, whatever they are on that copy.
for _, f in ipairs {
  { name = "a barometer whose PROM fails its check", kind = "sensor_wrong_identity", device = "baro", value = 1, told = "barometer silent" },
  { name = "a magnetometer of another make", kind = "sensor_wrong_identity", device = "mag", value = 0x55, told = "magnetometer silent" },
} do
  plan(f.name .. " is never armed") {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
    tags = { "flight", "faults" }, timeout = "60 s",
    run = function(t)
      t:fault { kind = f.kind, device = f.device, value = f.value }
      t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
      t:wait "3 s"
      local armed = t:always("told_armed")
      armed:at_most(0)
      t:command { arm = true }
      t:told("2 s", f.told)
      t:wait "2 s"
      armed:stop()
    end,
  }
end

-- A MultiMediaCard is not known; what its maker's number is counts nothing.
for _, f in ipairs {
  { name = "a card of a kind that the image does not know is flown without", logs = 0,
    fault = { kind = "sensor_wrong_identity", device = "card", value = 0 } },
  { name = "a card of another maker is written on like any", logs = 1,
    fault = { kind = "sensor_wrong_identity", device = "card", value = 3 } },
} do
  plan(f.name) {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
    tags = { "flight", "faults" }, timeout = "60 s",
    run = function(t)
      t:fault(f.fault)
      hover(t)
      t:expect(t:value "told_logging", "it says that it logs"):equal(f.logs)
      local r = t:record({ "height", "offset" }, "4 s")
      t:expect(r:rms_error("height", "1.1 m"), "height RMS error"):at_most "5 cm"
      t:expect(r:rms "offset", "sideways RMS error"):at_most "10 cm"
    end,
  }
end
