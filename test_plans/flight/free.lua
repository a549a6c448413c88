-- The vehicle stands in the camera room and nobody flies it: what `whirl fly` starts with. As a plan of its own it
-- shows that the image boots, is heard and keeps still until it is commanded.
plan "free" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "20 s",
  run = function(t)
    t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
    t:wait "3 s"
    t:expect(t:value "told_armed", "armed"):at_most "0"
    t:expect(t:value "height", "height"):at_most "30 cm"
    t:expect(t:value "offset", "offset"):at_most "1 mm"
  end,
}
