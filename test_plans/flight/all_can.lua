-- IMU, barometer, magnetometer, GPS, battery and ESCs all nodes of one CAN bus (board px4fmu_v1_all_can): the
-- flights of the board's own sensors with their limits, the lines on buses replaced by CAN's.
include "include/judged_hover.lua"
include "include/hover.lua"
include "include/figure_8.lua"
include "include/all_can.lua"

-- From reset to ready with the parameters as flash has them.
plan "boot_all_can" {
  image = "flight", board = "px4fmu_v1_all_can", vehicle = "hp_quad",
  tags = { "flight", "can" }, timeout = "30 s",
  run = function(t)
    boot_all_can(t)
    t:fault { kind = "reset_pin" }
    t:wait "500 ms"
    t:step "sensors"
    imu_on_can(t, "1 s")
    sensors_on_can(t, "1 s")
    escs_on_can(t, "1 s")
    t:step "ready"
    t:within("5 s", function(s) return s.told_ready == 1 end, "it says that it can be armed")
    t:wait "200 ms"
    t:expect(t:value "attitude_error", "attitude, flown by"):at_most "1 deg"
    t:expect(t:value "parameter_result", "the parameters were taken over"):equal(0)
    t:command { arm = true }
    t:within("1 s", function(s) return s.told_armed == 1 end, "armed")
  end,
}

for _, of in ipairs { { name = "hover_all_can", board = "px4fmu_v1_all_can", message = imu14, load = "46 %" },
                      { name = "hover_all_can_16", board = "px4fmu_v1_all_can_16", message = imu16, load = "57 %" } } do
  plan(of.name) {
    image = "flight", board = of.board, vehicle = "hp_quad",
    tags = { "flight", "can" }, timeout = "60 s",
    run = function(t)
      boot_all_can(t)
      judged_hover(t, function()
        escs_on_can(t, "20 s")
        sensors_on_can(t, "20 s")
      end, function() imu_on_can(t, "20 s", of.message, of.load) end)
    end,
  }
end

plan "position_step_all_can" {
  image = "flight", board = "px4fmu_v1_all_can", vehicle = "hp_quad",
  tags = { "flight", "can" }, timeout = "60 s",
  run = function(t)
    boot_all_can(t)
    hover(t)
    imu_on_can(t, "6 s")
    escs_on_can(t, "6 s")
    judged_step(t)
  end,
}

plan "figure_8_all_can" {
  image = "flight", board = "px4fmu_v1_all_can", vehicle = "hp_quad",
  tags = { "flight", "can" }, timeout = "120 s",
  run = function(t)
    boot_all_can(t)
    judged_figure_8(t)
  end,
}
