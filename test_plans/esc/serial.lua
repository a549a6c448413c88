-- The serial line: answers, parameters that come back as they were set, and the stream of internal signals.
include "include/start.lua"

local function line_plan(name, run)
  plan(name) {
    image = "esc", board = "esc32v2",
    stand = { prop = "hk_10x4.5", battery = "4s_2200" },
    watch = { "fw::esc::control_task", "fw::esc::commutation_task" },
    tags = { "esc", "quick" },
    timeout = "30 s",
    run = run,
  }
end

line_plan("serial_parameters", function(t)
  t:wait "200 ms"
  t:step "what is set comes back"
  for name, value in pairs { kt = "9.1e-3", c0 = "1.2345678e-1", inertia = "3.8e-5", offset = "-0.25", a1 = "-1.4e-3" } do
    t:ask("set " .. name .. " " .. value, "^ok$")
    local text = t:ask("get " .. name, "^" .. name .. " %-?%d%.%d+e%-?%d+$")
    local told = tonumber(text:match "%S+$") or 0 / 0
    t:expect(math.abs(told / tonumber(value) - 1), name .. " as set, relative"):at_most(6e-8) -- half a float's last bit
    t:ask("set " .. name .. " " .. text:match "%S+$", "^ok$")
    t:ask("get " .. name, "^" .. text:gsub("%p", "%%%0") .. "$")
  end
  t:step "what is not understood is refused"
  t:ask("set kt 9.1e", "^refused$")
  t:ask("set nothing 1", "^refused$")
  t:ask("get nothing", "^refused$")
  t:ask("stream 2000", "^refused$")
  t:ask("nonsense", "^unknown: ")
  t:ask("get kt", "^kt 9.1000")
  t:ask("get mode", "^mode 2$")
  t:ask("get motor", "^motor 1$")
  t:ask("get identified", "^identified 0$")
end)

line_plan("serial_stream", function(t)
  start(t, "2 N")
  t:ask("set kt 9e-3", "^refused$") -- not while it turns
  t:step "500 frames a second, 10 answers a second"
  t:ask("stream 500", "^ok$")
  t:wait "50 ms"
  t:budget("fw::esc::control_task") { period = "1 ms", jitter = "20 us", response = "500 us", during = "2 s", margin = "10 %" }
  t:budget("fw::esc::commutation_task") { latency = "10 us", during = "2 s", margin = "10 %" }
  t:budget("cpu") { busy = "60 %", during = "2 s", margin = "10 %" }
  for _ = 1, 16 do
    t:ask("status", "^mode 2 flags %d+ rpm %d+ mA %d+ mV %d+ mN %d+ mW %d+ ")
    t:ask("get all", "^kt ")
    t:wait "90 ms"
  end
  t:expect(t:value "esc_frames_lost", "frames lost"):equal(0)
  local r = t:record({ "esc_speed", "esc_duty" }, "500 ms")
  t:expect(r:min "esc_speed", "speed as streamed"):at_least "340 rad/s"
  t:expect(math.abs(t:value("esc_speed", "rad/s") / t:value("speed", "rad/s") - 1), "speed streamed against truth"):at_most(0.02)
  -- Dividers of 1 % and the reference are the copy's; noise and steps are 0.1 % of it, ripple the rest.
  local shown = math.abs(t:value("esc_bus_voltage", "V") / t:value("sensed_voltage", "V") - 1)
  t:expect(shown, "voltage streamed against what this copy's divider shows"):at_most(0.005)
  t:expect(r:min "esc_duty", "duty"):within("20 %", "60 %")
  t:expect(t:value "esc_mode", "mode"):equal(2)
  t:step "silent again"
  t:ask("stream 0", "^ok$")
  t:wait "150 ms"
  t:within("1 ms", function(s) return s.esc_speed_radps ~= s.esc_speed_radps end, "stale signals are no numbers")
end)
