-- From reset to ready: the first heartbeat, every sensor set up and read at its rate, the filters converged, ready to
-- be armed. How long each took is in the results, by the run's own clock since the supply came.
plan "boot" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "quick", "flight" }, timeout = "20 s",
  run = function(t)
    t:within("500 ms", function(s) return s.heartbeat_age_s < 1 end, "the first heartbeat")
    t:wait(string.format("%.3f s", 0.5 - t:value("heartbeat_age", "s")))
    t:step "sensors" -- set up before: what they are asked from now on is asked at its rate, and answered
    t:bus { device = "imu", bytes = 15, period = "1 ms", tolerance = "20 us", during = "1 s" }
    t:bus { device = "baro", direction = "read", bytes = 3, period = "10 ms", tolerance = "11 ms", during = "1 s" }
    t:bus { device = "mag", direction = "read", bytes = 6, period = "10 ms", tolerance = "11 ms", during = "1 s" }
    for _, esc in ipairs { "esc1", "esc2", "esc3", "esc4" } do
      t:bus { device = esc, direction = "read", period = "50 ms", tolerance = "1 ms", during = "1 s" }
    end
    t:step "ready"
    t:within("5 s", function(s) return s.told_ready == 1 end, "it says that it can be armed")
    t:wait "200 ms" -- the filters are told at 5 Hz
    t:expect(t:value "attitude_error", "attitude, flown by"):at_most "1 deg"
    for filter = 1, 2 do
      t:expect(t:value("attitude_error_" .. filter), "attitude of filter " .. filter):at_most "1 deg"
      t:expect(t:value("told_scale_" .. filter), "scale of filter " .. filter):within(0.97, 1.03)
    end
    t:command { arm = true }
    t:within("1 s", function(s) return s.told_armed == 1 end, "armed")
  end,
}
