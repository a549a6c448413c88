-- The pod plays an MPU-6000 to a flight controller: what the flight image did to its own IMU from reset on (boot.txt:
-- hover, seed 1, its first 0.45 s; record.sh makes longer ones) is done to the pod at the same clock rates, and every byte of its
-- answers compared with the recorded ones. The stand only gives the plan a world; nothing of it is on this board.
-- Limits are the part's and the recording's: a register's answer has half a period of 656 kHz, 762 ns, and half of
-- that is to be left; after a burst the next transfer comes 1.5 us later, its first bit 0.4 us after that.
plan "pod_imu" {
  image = "pod", board = "pod_rig",
  stand = { prop = "hk_10x4.5", supply = "16 V" },
  tags = { "pod", "quick" },
  timeout = "10 s",
  run = function(t)
    t:wait "100 ms"
    t:budget("spi1_handler") { execution = "0.6 us", latency = "0.25 us", during = "300 ms", margin = "10 %" }
    t:budget("exti15_10_handler") { execution = "20 us", latency = "1.5 us", during = "300 ms", margin = "10 %" }
    t:budget("stack") { depth = "1 KiB", margin = "10 %" }
    t:ask("done", "^done 1$", "3 s")
    local function figure(name) return tonumber(t:ask(name, "^" .. name .. " %-?%d+$"):match "%S+$") or 0 / 0 end
    for _, kind in ipairs { "command", "burst", "read", "write" } do
      t:expect(figure(kind .. "_bytes"), kind .. ": bytes compared"):at_least(10)
      t:expect(figure(kind .. "_wrong"), kind .. ": bytes that differ"):equal(0)
      t:expect(figure(kind .. "_late"), kind .. ": bytes not prepared in time"):equal(0)
    end
    t:expect(figure "command_least_wait_ns", "slack of being ready again, ns"):at_least(200)
    t:expect(figure "burst_least_wait_ns", "slack of a burst's byte, ns"):at_least(381)
    t:expect(figure "read_least_wait_ns", "slack of a register's answer, ns"):at_least(381)
    t:expect(figure "link_most_ns", "from a sample's sending to data-ready, ns"):at_most(200e3)
    for _, count in ipairs { "lost", "late", "damaged", "oddities", "overlaps", "late_rearm" } do
      t:expect(figure("pod_" .. count), "the pod's count of " .. count):equal(0)
    end
    t:expect(figure "no_ready", "samples without data-ready"):equal(0)
  end,
}
