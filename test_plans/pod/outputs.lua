-- The pod plays a GPS and a receiver, its host on CAN: what is on the lines is what the host gave, at the parts' times.
-- SBUS 100000 baud 8E2: 120 us a character, a frame each 14 ms; CPPM in steps of 0.5 us. A sample of three frames
-- is late 250 us after its millisecond (firmware/pod/sample_watch.hpp). A channel of CPPM lasts 0.9 ms at least:
-- half of that is the limit of its interrupt; three frames of the CAN's block pass in 0.33 ms at least: so is a third.
plan "pod_outputs" {
  image = "pod", board = "pod_outputs_rig",
  stand = { prop = "hk_10x4.5", supply = "16 V" },
  tags = { "pod", "quick" },
  timeout = "10 s",
  run = function(t)
    t:wait "200 ms"
    t:budget("tim4_handler") { execution = "20 us", latency = "100 us", during = "1 s", margin = "10 %" }
    t:budget("can2_rx0_handler") { execution = "20 us", latency = "100 us", during = "1 s", margin = "10 %" }
    t:budget("can2_tx_handler") { execution = "20 us", latency = "100 us", during = "1 s", margin = "10 %" }
    t:budget("stack") { depth = "1 KiB", margin = "10 %" }
    t:wait "1.5 s"
    local function figure(name) return tonumber(t:ask(name, "^" .. name .. " %-?%d+$"):match "%S+$") or 0 / 0 end
    for name, least in pairs { sbus_frames = 100, cppm_frames = 60 } do
      t:expect(figure(name), name):at_least(least)
    end
    for _, name in ipairs { "sbus_wrong", "cppm_wrong", "gps_wrong", "gps_off_rate", "pod_lost", "pod_late", "pod_damaged", "pod_unsent",
                            "pod_gps_dropped" } do
      t:expect(figure(name), name):equal(0)
    end
    t:expect(figure "gps_bytes", "bytes of the GPS"):at_least(100)
    t:expect(figure "sbus_character_most_ns", "SBUS: a character, ns"):equal(120e3)
    t:expect(figure "sbus_period_least_ns", "SBUS: shortest period, ns"):at_least(13.9e6)
    t:expect(figure "sbus_period_most_ns", "SBUS: longest period, ns"):at_most(14.1e6)
    t:expect(figure "cppm_off_ns", "CPPM: a channel off by, ns"):at_most(10)
    t:expect(figure "pod_turn_us", "longest turn of the main loop, us"):at_most(100)
  end,
}
