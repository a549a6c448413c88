-- The ESCs on CAN by DroneCAN (board px4fmu_v1_can), all else as on I2C: the same flights with the same
-- limits, their lines on the ESCs' bus replaced by CAN's.
include "include/judged_hover.lua"
include "include/hover.lua"
include "include/figure_8.lua"
include "include/parameter.lua"

-- Set-points in one frame for all, priority 5; of each ESC three frames of esc.Status and one of
-- StatusExtended every 50 ms, of every node NodeStatus each second. Behind a frame that has begun the
-- set-points wait 160 us at most.
local raw_command, esc_status = 1030, 1034
local function can_windows(t, during)
  t:can { bus = "can2", from = "mcu", message = raw_command, period = "20 ms", tolerance = "0.5 ms", during = during }
  for _, esc in ipairs { "esc1", "esc2", "esc3", "esc4" } do
    t:can { bus = "can2", from = esc, message = esc_status, period = "50 ms", tolerance = "1 ms", during = during }
  end
  t:can { bus = "can2", load = "10 %", during = during }
end

local function boot_on_can(t)
  t:step "boot"
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  set_parameter(t, "ESC_BUS", 1)
  t:wait "3 s" -- gyro bias on the ground, capture poses, ESC arming zeros
end

plan "hover_dronecan" {
  image = "flight", board = "px4fmu_v1_can", vehicle = "hp_quad",
  tags = { "quick", "flight", "can" }, timeout = "60 s",
  run = function(t)
    boot_on_can(t)
    judged_hover(t, function() can_windows(t, "20 s") end)
  end,
}

plan "position_step_dronecan" {
  image = "flight", board = "px4fmu_v1_can", vehicle = "hp_quad",
  tags = { "flight", "can" }, timeout = "60 s",
  run = function(t)
    boot_on_can(t)
    hover(t)
    can_windows(t, "6 s")
    judged_step(t)
  end,
}

plan "figure_8_dronecan" {
  image = "flight", board = "px4fmu_v1_can", vehicle = "hp_quad",
  tags = { "flight", "can" }, timeout = "120 s",
  run = function(t)
    boot_on_can(t)
    judged_figure_8(t)
  end,
}
