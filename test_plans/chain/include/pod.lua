-- The flight image on its board, its sensors, and where it has them its ESCs, GPS and receiver, played by the pod image on a
-- board of its own: SPI, I2C and UARTs join the two, byte by byte in time; the line of data-ready comes 100 us later than the
-- pod puts it out; what an ESC is told reaches the plant by the pod's host alone, and so comes its status back.
local function sensors()
  return {
    { from = "flight.imu", to = "pod.spi1", select = "PA15", ready = "PC4", latency = "100 us" },
    { from = "flight.baro", to = "pod.i2c1" },
    { from = "flight.mag", to = "pod.i2c1" },
  }
end

-- more: wires besides those of sensors and ESCs.
function pod_plan(name, run, board, more)
  local wires = sensors()
  for i, wire in ipairs(more or {}) do wires[7 + i] = wire end
  for n = 1, 4 do wires[3 + n] = { from = "flight.esc" .. n, to = n < 3 and "pod.i2c2" or "pod.i2c3" } end
  plan(name) {
    nodes = {
      { name = "flight", image = "flight", board = "px4fmu_v1",
        watch = { "fw::imu_task", "fw::attitude_task", "fw::esc_task" } },
      { name = "pod", image = "pod", board = board or "pod_with_parts" },
    },
    wires = wires, vehicle = "hp_quad", tags = { "chain", "nightly" }, timeout = "60 s", run = run,
  }
end

-- A figure of the pod's host.
function figure(t, name) return tonumber(t:ask(name, "^" .. name .. " %-?%d+$"):match "%S+$") or 0 / 0 end

-- An overlap: a sample is stored, for a microsecond in each millisecond, as the flight controller begins a transfer. Its bursts
-- follow data-ready and never meet that, its checks of registers, which are of no sample, do by chance: once in a few flights.
function nothing_late(t)
  t:expect(figure(t, "pod_overlaps"), "the pod's count of overlaps"):at_most(3)
  t:expect(figure(t, "spi_first_late") + figure(t, "spi_other_late"), "bytes not prepared in time"):equal(0)
  for _, count in ipairs { "lost", "late", "damaged", "oddities", "late_rearm", "unsent", "gps_dropped" } do
    t:expect(figure(t, "pod_" .. count), "the pod's count of " .. count):equal(0)
  end
end

-- Arm, take-off, hover and landing. Limits are those of test_plans/flight/hover.lua. A register's answer has half a period of 656 kHz,
-- 762 ns: half of that is to be left. Jitter of the IMU's task: hover's 20 us, and 5 of the pod's clock (docs/pod.md).
-- `host`: windows on its link, and where an answer may be late by more: `answer_ns` is left, `latency` passes before its handler.
function pod_hover(t, host)
  host = host or {}
  t:step "boot"
  heartbeat(t)
  if host.windows then host.windows(t) end
  t:command { arm = true }
  t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
  t:budget("flight/fw::imu_task") { period = "1 ms", jitter = "25 us", execution = "100 us", during = "10 s", margin = "10 %" }
  t:budget("pod/spi1_handler") { execution = "0.6 us", latency = host.latency or "0.25 us", during = "10 s", margin = "10 %" }
  t:budget("pod/exti15_10_handler") { execution = "20 us", latency = "1.5 us", during = "10 s", margin = "10 %" }

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
  t:expect(figure(t, "spi_other_bytes"), "bytes of answers on SPI"):at_least(100e3)
  t:expect(figure(t, "spi_first_least_wait_ns"), "slack of being ready again, ns"):at_least(200)
  t:expect(figure(t, "spi_other_least_wait_ns"), "slack of an answer, ns"):at_least(host.answer_ns or 381)
  t:expect(figure(t, "setpoints"), "set-points of the four ESCs, 15 s of 50 a second each"):at_least(15 * 4 * 50)
  t:expect(figure(t, "setpoints_refused"), "set-points with a wrong checksum"):equal(0)
  nothing_late(t)
  lands(t)
end

-- All of its sensors are the pod's, a GPS and a receiver with SBUS as well: characters pass between the boards' UARTs, each in
-- the time that it takes. Outdoors nothing but the GPS tells where it is, and nothing but the receiver flies it; each is
-- shown by being there, and by its wire being cut. Limits of a hover by GPS: test_plans/flight/include/judged_gps.lua,
-- for a sixth of the time. `windows`: on the link of the pod's host.
function pod_receivers(name, board, windows)
  local receivers = sensors()
  receivers[4] = { from = "flight.gps", to = "pod.usart6", fastest = "57600 baud" }
  receivers[5] = { from = "flight.sbus", to = "pod.usart2", fastest = "100000 baud" }
  plan(name) {
    nodes = {
      { name = "flight", image = "flight", board = "px4fmu_v1_sbus",
        watch = { "fw::imu_task", "fw::attitude_task", "fw::gps_task" } },
      { name = "pod", image = "pod", board = board },
    },
    wires = receivers, vehicle = "hp_quad", tags = { "chain", "nightly" }, timeout = "120 s",
    outdoors = true, fence = { radius = "40 m", height = "20 m" },
    run = function(t)
      t:step "a fix, and sticks"
      t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
      t:command { rc = { mode = 2 } }
      t:within("60 s", function(s) return s.receiver_north_m == s.receiver_north_m end, "the origin of its frame is told")
      t:wait "4 s"
      t:command { rc = { arm = true } }
      t:within("2 s", function(s) return s.told_armed == 1 end, "armed by the switch")
      if windows then windows(t) end
      t:budget("flight/fw::gps_task") { execution = "200 us", response = "500 us", margin = "10 %" }
      t:wait "2 s"

      t:step "by hand"
      t:command { rc = { thrust = "100 %" } }
      t:within("10 s", function(s) return s.height_m > 2 end, "2 m high")
      t:command { rc = { thrust = "50 %" } }
      t:wait "3 s"
      local hover = t:record({ "velocity_error_north", "velocity_error_east", "tilt" }, "5 s")
      t:expect(hover:rms_error { velocity_error_north = "0 m/s", velocity_error_east = "0 m/s" }, "RMS error of velocity over ground"):at_most "0.4 m/s"
      t:expect(hover:max "tilt", "tilt"):at_most "25 deg"
      t:expect(t:value "told_state", "flown by hand"):equal(2)
      nothing_late(t)

      t:step "the receiver's wire is cut"
      t:fault { kind = "uart_silence", bus = "flight/usart1" }
      t:within("2.5 s", function(s) return s.told_state == 3 end, "landing")
      t:told("3 s", "radio control lost")

      t:step "and the GPS's, at the pod's end"
      t:fault { kind = "uart_silence", bus = "pod/usart6" }
      t:within("3 s", function(s) return s.told_state == 4 end, "failsafe landing")
      t:within("40 s", function(s) return s.on_ground == 1 end, "on the ground")
    end,
  }
end
