-- What the plans share in which all sensors and ESCs are nodes of CAN2 (boards px4fmu_v1_all_can...).
--
-- A message of the IMU is two frames (or three); before the first it waits for one that has begun, and set-points,
-- which alone are more urgent, may come between: two frames of 160 us at most. That much its ticks are uneven,
-- beside the 20 us that the image has to itself.
include "include/parameter.lua"

imu14, imu16, field, pressure, fix, battery = 20100, 20101, 1002, 1028, 1063, 1092
raw_command, esc_status = 1030, 1034
uneven = "340 us"

function boot_all_can(t)
  t:step "boot"
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  set_parameter(t, "SENS_BUS", 1)
  set_parameter(t, "ESC_BUS", 1)
  t:wait "3 s" -- gyro bias on the ground, capture poses, ESC arming zeros
end

-- The IMU's own clock may be 1 % off: 10 us. Load: 32 % of the IMU (imu16: 43 %), 10 % of the ESCs, 4 % of all others.
function imu_on_can(t, during, message, load)
  t:budget("fw::imu_task") { period = "1 ms", jitter = uneven, execution = "100 us", during = during }
  t:can { bus = "can2", from = "imu", message = message or imu14, period = "1 ms", tolerance = uneven, during = during }
  t:can { bus = "can2", load = load or "46 %", during = during }
end

-- Of four conversions of 10 ms one is a temperature. The field: 75 Hz. The receiver, when it solves: 5 Hz.
function sensors_on_can(t, during)
  t:can { bus = "can2", from = "baro", message = pressure, period = "15 ms", tolerance = "6 ms", during = during }
  t:can { bus = "can2", from = "mag", message = field, period = "13.33 ms", tolerance = "1 ms", during = during }
  t:can { bus = "can2", from = "battery", message = battery, period = "100 ms", tolerance = "1 ms", during = during }
end

function escs_on_can(t, during)
  t:can { bus = "can2", from = "mcu", message = raw_command, period = "20 ms", tolerance = "0.5 ms", during = during }
  for _, esc in ipairs { "esc1", "esc2", "esc3", "esc4" } do
    t:can { bus = "can2", from = esc, message = esc_status, period = "50 ms", tolerance = "1 ms", during = during }
  end
end
