-- By GPS alone, in the wind, with the receiver and all else that is sensed nodes of one CAN bus (gnss.Fix2): the flight
-- of gps.lua with its limits, the lines on buses replaced by CAN's.
include "include/all_can.lua"
include "include/gps.lua"
include "include/judged_gps.lua"

plan "gps_all_can" {
  image = "flight", board = "px4fmu_v1_all_can", vehicle = "hp_quad",
  tags = { "flight", "can" }, timeout = "300 s",
  outdoors = true, air = wind, fence = { radius = "40 m", height = "20 m" },
  run = function(t)
    boot_all_can(t)
    t:step "cold start"
    arm_by_gps(t)
    t:budget("cpu") { busy = "60 %", margin = "10 %" }
    t:budget("fw::attitude_task") { execution = "300 us", response = "500 us", margin = "10 %" }
    -- The receiver solves 5 times a second, by its own clock, and some of its work takes longer than other.
    t:can { bus = "can2", from = "gps", message = fix, period = "200 ms", tolerance = "10 ms", during = "60 s" }
    imu_on_can(t, "60 s")
    sensors_on_can(t, "60 s")
    escs_on_can(t, "60 s")
    judged_gps(t)
  end,
}
