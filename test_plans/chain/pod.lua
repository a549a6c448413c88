-- The flight image on its board, its IMU, barometer, magnetometer and four ESCs played by the pod image on a board of its
-- own: SPI and I2C join the two, byte by byte in time; the line of data-ready comes 100 us later than the pod puts it
-- out; what an ESC is told reaches the plant by the pod's host alone, and so comes its status back. Limits
-- are those of test_plans/flight/hover.lua. A register's answer has half a period of 656 kHz, 762 ns: half of that
-- is to be left. Jitter of the IMU's task: hover's 20 us, and the 20 us within which the pod's data-ready follows a sample
-- (docs/pod.md).
include "include/flights.lua"

local function pod_plan(name, run)
  plan(name) {
    nodes = {
      { name = "flight", image = "flight", board = "px4fmu_v1",
        watch = { "fw::imu_task", "fw::attitude_task", "fw::esc_task" } },
      { name = "pod", image = "pod", board = "pod_with_parts" },
    },
    wires = {
      { from = "flight.imu", to = "pod.spi1", select = "PA15", ready = "PC4", latency = "100 us" },
      { from = "flight.baro", to = "pod.i2c1" },
      { from = "flight.mag", to = "pod.i2c1" },
      { from = "flight.esc1", to = "pod.i2c2" },
      { from = "flight.esc2", to = "pod.i2c2" },
      { from = "flight.esc3", to = "pod.i2c3" },
      { from = "flight.esc4", to = "pod.i2c3" },
    },
    vehicle = "hp_quad", tags = { "chain", "nightly" }, timeout = "60 s", run = run,
  }
end

pod_plan("pod hover", function(t)
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
  local hover = t:record({ "height", "offset", "tilt", "baro_height_error" }, "5 s")
  t:expect(hover:rms_error("height", "1.1 m"), "hover: height RMS error"):at_most "5 cm"
  t:expect(hover:rms_error("offset", "0 m"), "hover: sideways RMS error"):at_most "10 cm"
  t:expect(hover:rms "tilt", "hover: tilt RMS"):at_most "3 deg"
  -- The air itself wanders by 0.2 m in the time; pressure the wrong way round is 2.2 m off.
  t:expect(hover:rms "baro_height_error", "hover: height by the air"):at_most "50 cm"

  t:step "the pod"
  local function figure(name) return tonumber(t:ask(name, "^" .. name .. " %-?%d+$"):match "%S+$") or 0 / 0 end
  t:expect(figure "spi_other_bytes", "bytes of answers on SPI"):at_least(100e3)
  t:expect(figure "spi_first_late" + figure "spi_other_late", "bytes not prepared in time"):equal(0)
  t:expect(figure "spi_first_least_wait_ns", "slack of being ready again, ns"):at_least(200)
  t:expect(figure "spi_other_least_wait_ns", "slack of an answer, ns"):at_least(381)
  t:expect(figure "setpoints", "set-points of the four ESCs, 15 s of 50 a second each"):at_least(15 * 4 * 50)
  t:expect(figure "setpoints_refused", "set-points with a wrong checksum"):equal(0)
  for _, count in ipairs { "lost", "late", "damaged", "oddities", "overlaps", "late_rearm", "unsent" } do
    t:expect(figure("pod_" .. count), "the pod's count of " .. count):equal(0)
  end
  lands(t)
end)

-- A hover is level, and cameras tell it where it is: an axis the wrong way round would not be seen there. Held at a slant,
-- each tells another part of what there is. Limits: zero-g output 80 mg, 3 % of scale and half a degree of
-- misalignment make 1.2 m/s2; a turn at up to 60 deg/s, told 10 times a second, 10 deg/s; a tenth of the earth's field. An
-- axis turned round is off by 12 m/s2, 60 deg/s, 20 uT.
pod_plan("pod in the hand", function(t)
  heartbeat(t)
  local axes = { "x", "y", "z" }
  local function judged(r, name, quantity, limit)
    for _, axis in ipairs(axes) do
      t:expect(r:max_error(quantity .. "_" .. axis, "0 " .. limit:match "%S+$"), name .. ": " .. quantity .. "_" .. axis):at_most(limit)
    end
  end
  for _, slant in ipairs { { "40 deg", "0 deg" }, { "0 deg", "40 deg" } } do
    local name = "roll " .. slant[1] .. ", pitch " .. slant[2]
    local turn = t:record({ "gyro_error_x", "gyro_error_y", "gyro_error_z" }, "1.5 s", function()
      t:hold { roll = slant[1], pitch = slant[2], height = "1.5 m", over = "1.5 s" }
    end)
    judged(turn, name .. ", turning", "gyro_error", "10 deg/s")
    t:wait "2 s"
    local still = t:record({ "accel_error_x", "accel_error_y", "accel_error_z", "field_error_x", "field_error_y", "field_error_z" }, "2 s")
    judged(still, name, "accel_error", "1.2 m/s2")
    judged(still, name, "field_error", "6 uT")
  end
end)
