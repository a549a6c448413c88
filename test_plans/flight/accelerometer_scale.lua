-- An accelerometer that comes to read 3 % too much shows in the latent scale of both filters (thesis, section 6.2). It
-- comes in flight: what reads wrong on the ground already is found there as a zero point, and never shows.
include "include/hover.lua"

plan "accelerometer_scale" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "90 s",
  run = function(t)
    hover(t)
    t:wait "10 s"
    local signals = { "told_scale_1", "told_scale_2", "height", "attitude_error" }
    local before = t:record(signals, "10 s")
    t:expect(before:mean "told_scale_1", "before, filter 1"):within("0.99", "1.01")
    t:expect(before:mean "told_scale_2", "before, filter 2"):within("0.99", "1.01")
    t:step "the z axis reads 3 % more"
    t:fault { kind = "sensor_scale", device = "imu", axis = "accel_z", value = "3 %" }
    t:wait "15 s"
    local after = t:record(signals, "10 s")
    t:expect(after:mean "told_scale_1", "with 3 % more, filter 1"):within("1.02", "1.04")
    t:expect(after:mean "told_scale_2", "with 3 % more, filter 2"):within("1.02", "1.04")
    t:expect(after:rms_error("height", "1.1 m"), "height RMS error"):at_most "5 cm"
    t:expect(after:rms "attitude_error", "attitude, flown by"):at_most "1 deg"
  end,
}
