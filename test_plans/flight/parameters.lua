-- Parameters over the radio: what is set is answered, kept over a reset at any moment, refused beyond its
-- bounds and, where the image's table says so, while armed. Results: 0 it holds, 2 refused.

include "include/hover.lua"

local function answer(t, name, value)
  t:command { parameter = { name = name, value = value } }
  t:within("3 s", function(s) return s.parameter_pending == 0 end,
           name .. (value and string.format(" = %g", value) or "") .. ": answered")
  return t:value "parameter_value"
end

-- Sets a parameter, or reads it, and expects what it holds then.
local function ask(t, name, value, result, holds)
  local held = answer(t, name, value)
  local words = name .. (value and string.format(" = %g", value) or "")
  t:expect(held, words .. ": holds"):equal(holds)
  t:expect(t:value "parameter_result", words .. ": result"):equal(result)
end

local function reset(t)
  t:fault { kind = "reset_pin" }
  t:wait "1 ms"
end

local function parameter_plan(name, board, run)
  plan(name) {
    image = "flight", board = board, vehicle = "hp_quad",
    tags = { "quick", "flight" }, timeout = "60 s", watch = { "fw::store_task" },
    run = run,
  }
end

parameter_plan("parameters are set, bounded and kept over resets", "px4fmu_v1", function(t)
  t:step "boot"
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  ask(t, "EST_START_SCALE", nil, 0, 1)

  t:step "set and refuse"
  ask(t, "EST_START_SCALE", 1.25, 0, 1.25)
  ask(t, "EST_START_SCALE", 2, 2, 1.25)
  ask(t, "EST_FILTER", 0.5, 2, 1)

  t:step "reset"
  t:wait "1 s" -- half of it until it is written
  reset(t)
  ask(t, "EST_START_SCALE", nil, 0, 1.25)

  -- Two are changed together and the reset comes 6 ms later each time, across the 8 ms in which the
  -- eight words of their record are written. What is kept is the pair before or the new one, no mix.
  t:step "resets around the record"
  local kept = { scale = 1.25, tilt = 0 }
  for i = 0, 11 do
    local new = { scale = 1 + (i + 1) / 64, tilt = i + 1 }
    ask(t, "EST_START_SCALE", new.scale, 0, new.scale)
    ask(t, "EST_START_TILT", new.tilt, 0, new.tilt)
    t:wait(string.format("%d ms", 436 + 6 * i))
    reset(t)
    local is_new = answer(t, "EST_START_SCALE").value == new.scale
    if i == 0 then t:expect(is_new and 1 or 0, "reset 0 comes before the record"):equal(0) end
    if i == 11 then t:expect(is_new and 1 or 0, "reset 11 comes behind it"):equal(1) end
    if is_new then kept = new end
    ask(t, "EST_START_SCALE", nil, 0, kept.scale)
    ask(t, "EST_START_TILT", nil, 0, kept.tilt)
  end
end)

parameter_plan("parameters in flight are guarded, and written after the landing", "px4fmu_v1", function(t)
  hover(t)
  -- No word of flash is written here: one takes 16 us.
  t:budget("fw::store_task") { execution = "5 us", during = "2 s" }
  t:budget("fw::telemetry_task") { execution = "300 us", response = "500 us", during = "2 s", margin = "10 %" }
  for _, esc in ipairs { "esc1", "esc2", "esc3", "esc4" } do
    t:bus { device = esc, direction = "write", period = "20 ms", tolerance = "0.5 ms", during = "2 s" }
  end
  ask(t, "EST_START_TILT", 60, 2, 0)
  ask(t, "EST_FILTER", 0, 2, 1)
  ask(t, "CTL_FEEDFWD", 0, 0, 0)
  t:wait "2 s"
  t:command { land = true }
  t:within("10 s", function(s) return s.told_armed == 0 end, "landed and disarmed")
  t:wait "1 s"
  reset(t)
  ask(t, "CTL_FEEDFWD", nil, 0, 0)
  ask(t, "EST_FILTER", nil, 0, 1)
end)

-- An erase takes 0.25 s: the first start makes one sector blank, the second start the other one.
parameter_plan("sectors that hold something else are erased at the start", "px4fmu_v1_used", function(t)
  local early = t:wait_until(function(s) return s.heartbeat_age_s < 1.5 end, "250 ms")
  t:expect(early and 1 or 0, "heartbeats while it erases"):equal(0)
  t:within("1 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  ask(t, "EST_START_SCALE", 1.25, 0, 1.25)
  for i, tilt in ipairs { 5, 10, 15 } do
    ask(t, "EST_START_TILT", tilt, 0, tilt)
    t:wait "1 s"
    reset(t)
    ask(t, "EST_START_TILT", nil, 0, tilt)
    ask(t, "EST_START_SCALE", nil, 0, 1.25)
  end
end)
