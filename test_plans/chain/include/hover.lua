-- Take off to 1.1 m, hover through a sideways gust, land. `bus` opens the windows on the wire to the ESCs; `boards`: the
-- controllers are.
function judged_hover(t, boards, bus)
  t:command { arm = true }
  t:within("3 s", function(s) return s.told_armed == 1 end, "armed")

  t:budget("flight/fw::imu_task") { period = "1 ms", jitter = "20 us", execution = "100 us", during = "20 s", margin = "10 %" }
  t:budget("flight/fw::esc_task") { execution = "200 us", response = "500 us", during = "20 s", margin = "10 %" }
  t:budget("flight/cpu") { busy = "60 %", during = "20 s", margin = "10 %" }
  bus(t)
  if boards then
    for _, esc in ipairs(escs) do
      t:budget(esc .. "/fw::esc::control_task") { period = "1 ms", jitter = "50 us", response = "600 us", during = "20 s", margin = "10 %" }
      t:budget(esc .. "/cpu") { busy = "85 %", during = "20 s", margin = "10 %" }
    end
  end
  t:latency { from = "flight/imu", through = { "flight/fw::imu_task", "flight/fw::attitude_task" },
              to = "flight/esc", at_most = "7 ms", during = "20 s" }

  t:step "take-off"
  t:command { takeoff = "1.1 m" }
  t:within("5 s", function(s) return s.height_m > 1.0 end, "1 m high")
  t:wait "7 s"

  t:step "gust"
  local tilt = t:always("tilt")
  tilt:at_most "20 deg"
  local gust = t:record({ "offset", "height" }, "6 s", function()
    t:gust { east = "2 m/s", duration = "1 s" }
  end)
  t:expect(gust:max "offset", "gust: it moves the vehicle"):within("15 cm", "60 cm")
  t:expect(gust:settled("10 cm", { offset = "0 m" }), "gust: back within 10 cm"):at_most "4 s"

  t:step "hover, judged"
  local hover = t:record({ "height", "offset", "tilt", "bus_current_1", "bus_current_2", "bus_current_3",
                           "bus_current_4" }, "10 s")
  t:expect(hover:rms_error("height", "1.1 m"), "hover: height RMS error"):at_most "5 cm"
  t:expect(hover:rms_error("offset", "0 m"), "hover: sideways RMS error"):at_most "10 cm"
  t:expect(hover:rms "tilt", "hover: tilt RMS"):at_most "3 deg"
  for motor = 1, 4 do
    t:expect(hover:mean("bus_current_" .. motor), "hover: bus current of motor " .. motor):within("1.27 A", "1.55 A")
  end
  tilt:stop()
  lands(t)
end
