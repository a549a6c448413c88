-- Faults of sensors that are nodes of CAN (board px4fmu_v1_all_can), in mid-hover: by the rules and limits of the
-- same faults of the board's own (faults.lua, faults_sensors.lua).
include "include/hover.lua"
include "include/moment.lua"
include "include/sensor_fault.lua"
include "include/all_can.lua"

local function fault_plan(name, run)
  plan("CAN: " .. name) {
    image = "flight", board = "px4fmu_v1_all_can", vehicle = "hp_quad",
    tags = { "flight", "faults", "can" }, timeout = "60 s",
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

local function stops(name, fault)
  fault_plan(name, function(t)
    t:fault(fault)
    t:within("2 s", function(s) return s.told_armed == 0 end, "motors off")
  end)
end

flown_through("a rate of the IMU's node at its rail for 10 ms is not believed",
              { kind = "sensor_saturated", device = "imu", axis = "gyro_x", duration = "10 ms" })
flown_through("frames that nobody receives for 5 ms are flown through",
              { kind = "can_lost", bus = "can2", duration = "5 ms" })
flown_through("the IMU's node cut off for 5 ms is flown through",
              { kind = "can_cut", device = "imu", duration = "5 ms" })
stops("the IMU's node cut off for good stops the motors", { kind = "can_cut", device = "imu" })
stops("an IMU's node whose data stay stops the motors", { kind = "sensor_frozen", device = "imu" })

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
