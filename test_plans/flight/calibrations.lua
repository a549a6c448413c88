-- The image's own calibrations: gyro at rest, accelerometer from six sides, magnetometer turned all round. The plan draws
-- what the parts are off, up to the worst that their data sheets allow, and so can judge what was found; then it flies.
--
-- Limits, from the noise and from how still a hand is (harness/flight/hand.hpp):
--   gyro           0.005 deg/s per root Hz over 4 s: 0.0025 deg/s; its zero itself wanders by 0.01 deg/s RMS (flicker,
--                  four decades of it), and 16.4 counts per deg/s is 2000 deg/s over 32768 rounded: 0.1 % of 20 deg/s.
--                  0.06 deg/s (0.03, which left the last two out, was met by 4 of 5 seeds)
--   accelerometer  the mean of 1.2 s is off by noise (0.004 m/s^2) and by how the hand's speed has changed in it
--                  (sway of 1.5 mm at up to 1.2 Hz: 0.01 m/s^2). Offsets 0.04 m/s^2, scales 0.4 %
--   magnetometer   0.2 uT a sample, 500 samples and more: 0.02 uT, and counts of 0.09 uT; 0.15 uT

include "include/hover.lua"
include "include/calibration.lua"

-- Sensor axes are (x, -y, -z) of the body for the IMU, (y, -x, z) for the magnetometer (boards/px4fmu_v1.lua).
local parts = {
  { "gyro_x", "20 deg/s", "CAL_GYR_XOFF", 1 }, { "gyro_y", "20 deg/s", "CAL_GYR_YOFF", -1 },
  { "gyro_z", "20 deg/s", "CAL_GYR_ZOFF", -1 },
  { "accel_x", "0.49 m/s2", "CAL_ACC_XOFF", 1 }, { "accel_y", "0.49 m/s2", "CAL_ACC_YOFF", -1 },
  { "accel_z", "0.78 m/s2", "CAL_ACC_ZOFF", -1 },
  { "field_x", "50 uT", "CAL_MAG_YOFF", 1 }, { "field_y", "50 uT", "CAL_MAG_XOFF", -1 },
  { "field_z", "50 uT", "CAL_MAG_ZOFF", 1 },
}
local per_unit = { field = 1e6 } -- parameters are in uT, all else is SI

local function spoil(t)
  local truth = {}
  for _, part in ipairs(parts) do
    local axis, most, name, sign = table.unpack(part)
    local off = t:drawn("-" .. most, most)
    t:fault { kind = "sensor_offset", device = axis:find "field" and "mag" or "imu", axis = axis, value = off }
    truth[name] = sign * t:quantity(off) * (per_unit[axis:sub(1, 5)] or 1)
  end
  for axis, name in pairs { accel_x = "CAL_ACC_XSCALE", accel_y = "CAL_ACC_YSCALE", accel_z = "CAL_ACC_ZSCALE" } do
    local off = t:drawn("-3 %", "3 %")
    t:fault { kind = "sensor_scale", device = "imu", axis = axis, value = off }
    truth[name] = 1 / (1 + t:quantity(off))
  end
  return truth
end

local function judge(t, truth, names, limit)
  for _, name in ipairs(names) do
    t:expect(parameter(t, name) - truth[name], name .. ": off"):within(-limit, limit)
  end
end

local function boot(t)
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  t:wait "3 s"
end

plan "calibrations find what the parts are off" {
  image = "flight", board = "px4fmu_v1_exact_imu", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "200 s", watch = { "fw::store_task" },
  run = function(t)
    local truth = spoil(t)
    boot(t)
    t:budget("fw::imu_task") { period = "1 ms", jitter = "20 us", execution = "100 us", during = "60 s", margin = "10 %" }
    t:budget("fw::sensor_task") { execution = "1 ms", during = "80 s" }

    t:step "gyro"
    begin_calibration(t, "gyroscope")
    end_calibration(t, "gyroscope", "6 s", 0)

    t:step "accelerometer"
    begin_calibration(t, "accelerometer")
    show_sides(t, 6)
    end_calibration(t, "accelerometer", "3 s", 0)

    t:step "magnetometer"
    begin_calibration(t, "magnetometer")
    turn_round(t, 0, 330)
    end_calibration(t, "magnetometer", "3 s", 0)
    put_down(t)

    -- They are in flash by now, and come back from there.
    t:step "reset"
    t:fault { kind = "reset_pin" }
    t:wait "1 s"
    boot(t)
    judge(t, truth, { "CAL_GYR_XOFF", "CAL_GYR_YOFF", "CAL_GYR_ZOFF" }, t:quantity "0.06 deg/s")
    judge(t, truth, { "CAL_ACC_XOFF", "CAL_ACC_YOFF", "CAL_ACC_ZOFF" }, 0.04)
    judge(t, truth, { "CAL_ACC_XSCALE", "CAL_ACC_YSCALE", "CAL_ACC_ZSCALE" }, 0.004)
    judge(t, truth, { "CAL_MAG_XOFF", "CAL_MAG_YOFF", "CAL_MAG_ZOFF" }, 0.15)

    -- What the vehicle says it feels, standing: 30 samples of each. Along the floor the axes' lean and the board's turn bring
    -- in gravity, which no side tells: 0.065 and 0.051 m/s2 (1 sigma), three times 0.083 beside the 0.08 of the rest.
    t:step "standing"
    local errors = { "accel_error_x", "accel_error_y", "accel_error_z", "gyro_error_x", "gyro_error_y", "gyro_error_z",
                     "field_error_x", "field_error_y", "field_error_z" }
    local still = t:record(errors, "15 s")
    for i, name in ipairs(errors) do
      local limit = i <= 2 and "0.26 m/s2" or i == 3 and "0.08 m/s2" or i <= 6 and "0.1 deg/s" or "0.4 uT"
      t:expect(still:mean(name), "standing: " .. name):within("-" .. limit, limit)
    end

    t:step "hover"
    hover(t)
    t:wait "5 s"
    local flown = t:record({ "attitude_error", "heading_error", "heading_error_1", "offset", "height" }, "10 s")
    t:expect(flown:rms "attitude_error", "hover: attitude, RMS"):at_most "1 deg"
    -- Filter 1 has its heading from the field alone: 0.15 uT across 24 uT, and the motors' currents.
    t:expect(flown:mean "heading_error_1", "hover: heading by the field"):within("-1 deg", "1 deg")
    t:expect(flown:rms_error("height", "1.1 m"), "hover: height RMS error"):at_most "5 cm"
    t:expect(flown:rms_error("offset", "0 m"), "hover: sideways RMS error"):at_most "10 cm"
    t:command { land = true }
    t:within("12 s", function(s) return s.told_armed == 0 end, "landed and disarmed")
  end,
}

plan "calibrations refuse what they cannot use" {
  image = "flight", board = "px4fmu_v1_exact_imu", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "240 s",
  run = function(t)
    local function refused(what, result, words)
      t:command { calibrate = what }
      t:told("3 s", words)
      t:expect(t:value "calibration_result", what .. ": result"):equal(result)
    end
    boot(t)

    t:step "a gyro that moves"
    t:hold { height = "1 m", over = "2 s" }
    t:wait "3 s"
    begin_calibration(t, "gyroscope")
    t:told("6 s", "calibration failed: it moved")
    end_calibration(t, "gyroscope", "1 s", 4)

    t:step "five sides"
    begin_calibration(t, "accelerometer")
    show_sides(t, 5)
    t:told("40 s", "calibration failed: sides are missing")
    end_calibration(t, "accelerometer", "1 s", 4)

    t:step "half a sphere"
    begin_calibration(t, "magnetometer")
    turn_round(t, -60, 60)
    t:told("40 s", "calibration failed: not seen all round")
    end_calibration(t, "magnetometer", "1 s", 4)

    t:step "beyond the data sheet"
    t:fault { kind = "sensor_offset", device = "imu", axis = "accel_x", value = "1.2 m/s2", duration = "40 s" }
    begin_calibration(t, "accelerometer")
    show_sides(t, 6)
    t:told("3 s", "calibration failed: beyond the data sheet")
    end_calibration(t, "accelerometer", "1 s", 4)

    t:step "one at a time, cancelled, and no arming meanwhile"
    put_down(t)
    t:wait "15 s" -- the offset is over; zero points are found anew
    begin_calibration(t, "magnetometer")
    refused("gyroscope", 1, "a calibration runs")
    t:command { arm = true }
    t:told("3 s", "a calibration runs")
    t:expect(t:value "told_armed", "armed while it calibrates"):equal(0)
    t:command { calibrate = "cancel" }
    t:told("3 s", "calibration: cancelled")

    t:step "armed"
    t:command { arm = true }
    t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
    for _, what in ipairs { "gyroscope", "accelerometer", "magnetometer", "motor_fields" } do
      refused(what, 2, "not in this state")
    end
    t:command { arm = false }
    t:within("4 s", function(s) return s.told_armed == 0 end, "disarmed")

    t:step "nothing was kept"
    for _, name in ipairs { "CAL_GYR_XOFF", "CAL_ACC_XOFF", "CAL_ACC_ZOFF", "CAL_MAG_XOFF", "CAL_MAG_YZ", "CAL_MAG_M1X" } do
      t:expect(parameter(t, name), name):equal(0)
    end
  end,
}

-- The gyro's three zero points go into one record, half a second after they were found. The reset comes 2 ms later
-- each time, across the ticks in which its words are written: the old three or the new three, no mix.
plan "a calibration that is cut while it is stored is the old one or the new one" {
  image = "flight", board = "px4fmu_v1_exact_imu", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "200 s",
  run = function(t)
    local axes = { { "gyro_x", "CAL_GYR_XOFF", 1 }, { "gyro_y", "CAL_GYR_YOFF", -1 }, { "gyro_z", "CAL_GYR_ZOFF", -1 } }
    local near = t:quantity "0.06 deg/s"
    local kept, seen_old, seen_new = { 0, 0, 0 }, 0, 0
    boot(t)
    for i = 0, 9 do
      local off = {}
      for k, axis in ipairs(axes) do
        local drawn = t:drawn("1 deg/s", "10 deg/s")
        t:fault { kind = "sensor_offset", device = "imu", axis = axis[1], value = drawn, duration = "9 s" }
        off[k] = axis[3] * t:quantity(drawn)
      end
      t:wait "1 s"
      begin_calibration(t, "gyroscope")
      end_calibration(t, "gyroscope", "6 s", 0)
      t:wait(string.format("%d ms", 470 + 4 * i))
      t:fault { kind = "reset_pin" }
      t:wait "1 s"
      local found, old, new = {}, true, true
      for k, axis in ipairs(axes) do
        found[k] = parameter(t, axis[2])
        old = old and math.abs(found[k] - kept[k]) < near
        new = new and math.abs(found[k] - off[k]) < near
      end
      t:expect((old or new) and 1 or 0, "reset " .. i .. ": the old three or the new three"):equal(1)
      if new then seen_new = seen_new + 1 else seen_old = seen_old + 1 end
      kept = found
      t:wait_until(function(s) return s.heartbeat_age_s < 0 end, "2 s") -- the offsets are over
    end
    t:expect(seen_old, "resets that came before the record was whole"):at_least(1)
    t:expect(seen_new, "resets that came after"):at_least(1)
  end,
}
