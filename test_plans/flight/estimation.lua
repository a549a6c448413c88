-- What the filters make of a hover, against truth: attitude, latent scale, velocity through the air, height
-- and climb by the barometer. Vibration is on.
include "include/hover.lua"

plan "estimation" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "quick", "flight" }, timeout = "90 s",
  run = function(t)
    hover(t)
    t:wait "10 s"
    t:step "hover"
    t:budget("fw::sensor_task") { period = "10 ms", jitter = "100 us", execution = "100 us", during = "20 s", margin = "10 %" }
    t:budget("fw::Estimator::step_aided") { execution = "50 us", during = "20 s", margin = "10 %" }
    t:budget("fw::Estimator::step_explicit") { execution = "50 us", during = "20 s", margin = "10 %" }
    local r = t:record({ "attitude_error", "attitude_error_1", "attitude_error_2", "told_scale_1", "told_scale_2",
                         "air_velocity_error_x", "air_velocity_error_y", "baro_height_error", "baro_climb_error" }, "21 s")
    t:expect(r:rms "attitude_error", "attitude, flown by"):at_most "1 deg"
    t:expect(r:rms "attitude_error_1", "attitude, filter 1"):at_most "1 deg"
    t:expect(r:rms "attitude_error_2", "attitude, filter 2"):at_most "1 deg"
    t:expect(r:min "told_scale_1", "least scale, filter 1"):at_least "0.97"
    t:expect(r:max "told_scale_1", "largest scale, filter 1"):at_most "1.03"
    t:expect(r:rms_error { air_velocity_error_x = "0 m/s", air_velocity_error_y = "0 m/s" }, "velocity through the air"):at_most "0.15 m/s"
    t:expect(r:rms "baro_height_error", "height by the barometer"):at_most "20 cm"
    t:expect(r:rms "baro_climb_error", "climb by the barometer"):at_most "0.1 m/s"
  end,
}
