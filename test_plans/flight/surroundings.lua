-- Where a flight takes place and how it begins, without a flight: motors stand, truth judges the world.
plan "dropped onto a slope" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" },
  timeout = "20 s",
  room = { size = { "6 m", "6 m", "3 m" }, solid = true },
  obstacles = { { kind = "slope", north = "1 m", towards = "0 deg", angle = "10 deg" } },
  start = { height = "32 cm", north = "2 m", yaw = "90 deg", roll = "10 deg" }, -- gear along it, 3 cm off
  run = function(t)
    t:expect(t:value "fence_margin"):equal "1 m"
    local fall = t:record("climb", "50 ms", function() end)
    t:expect(fall:min(), "speed of the fall"):within("-0.5 m/s", "-0.45 m/s")
    t:within("3 s", function(s) return s.on_ground == 1 and math.abs(s.climb_mps) < 0.01 end, "down")
    t:wait "2 s"
    t:expect(t:value "tilt"):within("9.5 deg", "10.5 deg")
    t:expect(t:value "on_ground"):equal(1)
    t:expect(t:value "touching"):equal(0)
  end,
}

plan "thrown against a wall" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" },
  timeout = "20 s",
  room = { size = { "5 m", "4 m", "3 m" }, solid = true },
  start = { height = "2.5 m", velocity_north = "4 m/s", motor_speed = "4000 rpm" },
  run = function(t)
    t:within("1 s", function(s) return s.speed_1_radps == 0 end, "the front propeller struck the wall")
    t:within("1 s", function(s) return s.velocity_north_mps < 0 end, "back from the wall")
    t:within("3 s", function(s) return s.on_ground == 1 end, "down")
  end,
}
