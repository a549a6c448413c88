-- The motors' currents and the magnetometer. Nobody tells the image what an ampere adds: it runs one motor after the other
-- on the ground and finds that from what the ESCs tell of their currents, as PX4's commander does for the thesis's
-- vehicle. Judged by the heading that filter 1 has from the field alone, in hover.
--
-- Limit, before any figure was seen: a coefficient is off by 0.02 uT/A (motor_field_calibration.hpp), four motors
-- of 1.35 A by 0.05 uT; the ESCs' zeros are 0.4 A off until they are warm, and 0.5 uT/A turns that into 0.2 uT of each
-- motor, 0.4 uT in all: 1 degree across 24 uT. With the field's declination, that the image has from a map, 1.5.
-- Before, 6 A through the pack's leads alone turn the field by 4.9 degrees, of which filter 1 has followed 2.5.

include "include/hover.lua"
include "include/calibration.lua"

local function heading(t, name)
  hover(t)
  t:wait "25 s" -- filter 1 follows the field by 0.1 /s
  local flown = t:record({ "heading_error_1", "field_error_x", "field_error_y", "field_error_z" }, "15 s")
  t:command { land = true }
  t:within("12 s", function(s) return s.told_armed == 0 end, name .. ": landed and disarmed")
  return flown
end

plan "the motors' fields are found on the ground and taken off in the air" {
  image = "flight", board = "px4fmu_v1_cables", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "240 s",
  run = function(t)
    t:step "before"
    local before = heading(t, "before")
    t:expect(before:mean "heading_error_1", "before: heading by the field"):within("-30 deg", "-2 deg")
    t:wait "3 s"

    t:step "motors, one after the other"
    local stands = t:always("height")
    stands:at_most "13 cm"
    begin_calibration(t, "motor_fields")
    t:within("3 s", function(s) return s.told_armed == 1 end, "it says that motors may turn")
    t:command { takeoff = "1.1 m" }
    t:told("3 s", "a calibration runs")
    end_calibration(t, "motor_fields", "30 s", 0)
    t:within("3 s", function(s) return s.told_armed == 0 end, "disarmed again")
    stands:stop()
    t:wait "3 s"
    for motor = 1, 4 do
      for _, axis in ipairs { "X", "Y", "Z" } do
        t:log("CAL_MAG_M" .. motor .. axis .. " " .. parameter(t, "CAL_MAG_M" .. motor .. axis))
      end
    end

    t:step "after"
    local after = heading(t, "after")
    t:expect(after:mean "heading_error_1", "after: heading by the field"):within("-1.5 deg", "1.5 deg")
    t:expect(after:max_error { heading_error_1 = "0 deg" }, "after: heading by the field, worst"):at_most "2.5 deg"
    for _, axis in ipairs { "x", "y", "z" } do
      t:log("before: field_error_" .. axis .. " " .. before:mean("field_error_" .. axis).value)
      t:expect(after:mean("field_error_" .. axis), "after: field along " .. axis):within("-0.6 uT", "0.6 uT")
    end
  end,
}

plan "motors that run to be calibrated stop when they must" {
  image = "flight", board = "px4fmu_v1_cables", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "60 s",
  run = function(t)
    t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
    t:wait "3 s"
    local function stopped(how)
      t:within("2 s", function(s) return s.told_armed == 0 end, how .. ": disarmed")
      t:within("3 s", function(s) return s.speed_1_radps + s.speed_2_radps + s.speed_3_radps + s.speed_4_radps < 4 end,
               how .. ": the propellers stand")
      t:expect(t:value "calibration_result", how .. ": result"):equal(4)
    end
    begin_calibration(t, "motor_fields")
    t:wait "4 s"
    t:command { arm = false }
    stopped "disarmed by the station"
    t:wait "3 s"
    begin_calibration(t, "motor_fields")
    t:wait "4 s"
    t:fault { kind = "esc_stopped", motor = 3, duration = "1 s" }
    stopped "a motor that stops"
    t:expect(t:value "height", "it stands"):at_most "12 cm"
    t:expect(parameter(t, "CAL_MAG_M1X"), "nothing was kept"):equal(0)
  end,
}
