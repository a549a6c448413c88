-- Faults of sensors that are nodes of CAN (board px4fmu_v1_all_can), in mid-hover: by the rules and limits of the
-- same faults of the board's own (faults.lua, faults_sensors.lua). 20 ms without samples is an IMU lost, so that what takes the whole
-- bus is shorter than that of dronecan_faults.lua.
include "include/fail_safe.lua"
include "include/hover.lua"
include "include/moment.lua"
include "include/sensor_fault.lua"
include "include/all_can.lua"

local function fault_plan(name, run)
  plan("CAN: " .. name) {
    image = "flight", board = "px4fmu_v1_all_can", vehicle = "hp_quad",
    tags = { "flight", "faults", "can" }, timeout = "90 s",
    run = function(t)
      boot_all_can(t)
      hover(t)
      some_moment(t)
      run(t)
    end,
  }
end

local function flown_through(name, fault)
  fault_plan(name, function(t)
    t:fault(fault)
    t:wait "500 ms"
    local after = t:record({ "height", "offset", "tilt" }, "3 s")
    t:expect(after:rms_error("height", "1.1 m"), "after: height RMS error"):at_most "5 cm"
    t:expect(after:rms_error("offset", "0 m"), "after: sideways RMS error"):at_most "10 cm"
    t:expect(t:value "told_armed", "flies on"):equal(1)
  end)
end

local function stops(name, fault, words)
  fault_plan(name, function(t)
    t:fault(fault)
    cuts(t, words)
  end)
end

flown_through("a rate of the IMU's node at its rail for 10 ms is not believed",
              { kind = "sensor_saturated", device = "imu", axis = "gyro_x", duration = "10 ms" })
flown_through("frames that nobody receives for 5 ms are flown through",
              { kind = "can_lost", bus = "can2", duration = "5 ms" })
flown_through("the IMU's node cut off for 5 ms is flown through",
              { kind = "can_cut", device = "imu", duration = "5 ms" })
for _, f in ipairs {
  { "one frame spoiled is sent again", { kind = "can_bit_error", bus = "can2", duration = "1 s", value = 7 } },
  { "no acknowledge for 5 ms is flown through", { kind = "can_no_ack", bus = "can2", duration = "5 ms" } },
  { "the wire held dominant for 5 ms is flown through", { kind = "can_stuck_dominant", bus = "can2", duration = "5 ms" } },
  { "frames of all nodes that wait 200 us are flown through", { kind = "can_late", bus = "can2", duration = "1 s", value = "200 us" } },
  { "a babbling node that takes 30 % of the bus is flown through", { kind = "can_babble", bus = "can2", duration = "1 s", value = 0.3 } },
  { "the GPS receiver's node cut off for 2 s is flown through", { kind = "can_cut", device = "gps", duration = "2 s" } },
  { "the battery monitor's node cut off for 500 ms is flown through", { kind = "can_cut", device = "battery", duration = "500 ms" } },
} do
  flown_through(f[1], f[2])
end

stops("the IMU's node cut off for good stops the motors", { kind = "can_cut", device = "imu" }, "IMU gives no samples")
stops("an IMU's node whose data stay stops the motors", { kind = "sensor_frozen", device = "imu" }, "IMU samples are frozen")

for _, f in ipairs {
  { name = "the barometer's node reads 50 Pa more", kind = "sensor_offset", device = "baro", axis = "pressure", value = "50 Pa",
    baro = "4.8 m" }, -- 4.2 m of it
  { name = "the barometer's node cut off for 2 s", kind = "can_cut", device = "baro" },
  { name = "the barometer's supply behind its node fails", kind = "sensor_brown_out", device = "baro" },
  { name = "the magnetometer's node cut off for 2 s", kind = "can_cut", device = "mag" },
  { name = "the magnetometer behind its node overflows", kind = "sensor_saturated", device = "mag", axis = "field_y" },
} do
  fault_plan(f.name, function(t)
    imu_on_can(t, "3 s")
    judged_sensor_fault(t, f)
  end)
end
