-- The flight image on its board, its IMU, barometer and magnetometer played by the pod image on a board of its own: SPI
-- and I2C join the two, byte by byte in time; the line of data-ready comes 100 us later than the pod puts it out. Limits
-- are those of test_plans/flight/hover.lua. A register's answer has half a period of 656 kHz, 762 ns: half of that
-- is to be left. Jitter of the IMU's task: hover's 20 us, and the 20 us
-- within which the pod's data-ready follows a sample (docs/pod.md).
include "include/flights.lua"

plan "pod hover" {
  nodes = {
    { name = "flight", image = "flight", board = "px4fmu_v1",
      watch = { "fw::imu_task", "fw::attitude_task", "fw::esc_task" } },
    { name = "pod", image = "pod", board = "pod_with_parts" },
  },
  wires = {
    { from = "flight.imu", to = "pod.spi1", select = "PA15", ready = "PC4", latency = "100 us" },
    { from = "flight.baro", to = "pod.i2c1" },
    { from = "flight.mag", to = "pod.i2c1" },
  },
  vehicle = "hp_quad", tags = { "chain", "nightly" }, timeout = "60 s",
  run = function(t)
    t:step "boot"
    heartbeat(t)
    t:command { arm = true }
    t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
    t:budget("flight/fw::imu_task") { period = "1 ms", jitter = "40 us", execution = "100 us", during = "10 s" }
    t:budget("pod/spi1_handler") { execution = "0.6 us", latency = "0.25 us", during = "10 s" }
    t:budget("pod/exti15_10_handler") { execution = "20 us", latency = "1.5 us", during = "10 s" }

    t:step "take-off"
    t:command { takeoff = "1.1 m" }
    t:within("5 s", function(s) return s.height_m > 1.0 end, "1 m high")
    t:wait "5 s"

    t:step "hover, judged"
    local hover = t:record({ "height", "offset", "tilt" }, "5 s")
    t:expect(hover:rms_error("height", "1.1 m"), "hover: height RMS error"):at_most "5 cm"
    t:expect(hover:rms_error("offset", "0 m"), "hover: sideways RMS error"):at_most "10 cm"
    t:expect(hover:rms "tilt", "hover: tilt RMS"):at_most "3 deg"

    t:step "the pod"
    local function figure(name) return tonumber(t:ask(name, "^" .. name .. " %-?%d+$"):match "%S+$") or 0 / 0 end
    t:expect(figure "spi_other_bytes", "bytes of answers on SPI"):at_least(100e3)
    t:expect(figure "spi_first_late" + figure "spi_other_late", "bytes not prepared in time"):equal(0)
    t:expect(figure "spi_first_least_wait_ns", "slack of being ready again, ns"):at_least(200)
    t:expect(figure "spi_other_least_wait_ns", "slack of an answer, ns"):at_least(381)
    for _, count in ipairs { "lost", "late", "damaged", "oddities", "overlaps", "late_rearm", "unsent" } do
      t:expect(figure("pod_" .. count), "the pod's count of " .. count):equal(0)
    end
    lands(t)
  end,
}
