-- The log that the flight image writes onto its SD card, read back from the card, and what becomes of it
-- and of the flight when the card does not do its part.

include "include/hover.lua"

local held = { "height", "north", "east", "climb", "velocity_north", "velocity_east", "yaw", "rate_x", "rate_y",
               "rate_z", "told_north", "told_east", "told_height" }
-- All that is sampled at 150 Hz; 7 ms is the longest step between two samples.
local fast = { "vehicle_attitude", "sensor_combined", "vehicle_angular_velocity", "vehicle_local_position",
               "actuator_outputs" }

local function log_plan(name, tags, run, board)
  plan(name) {
    image = "flight", board = board or "px4fmu_v1", vehicle = "hp_quad", tags = tags, timeout = "90 s", run = run,
  }
end

-- Nothing of the flight may show that the card is in trouble: from now on.
local function undisturbed(t, during)
  t:budget("fw::imu_task") { period = "1 ms", jitter = "20 us", during = during, margin = "10 %" }
  t:budget("fw::log_task") { execution = "300 us", response = "500 us", during = during }
  for _, esc in ipairs { "esc1", "esc2", "esc3", "esc4" } do
    t:bus { device = esc, direction = "write", period = "20 ms", tolerance = "0.5 ms", during = during }
  end
end

local function steady(t, duration)
  local hover = t:record({ "height", "offset" }, duration)
  t:expect(hover:rms_error("height", "1.1 m"), "hover: height RMS error"):at_most "5 cm"
  t:expect(hover:rms_error("offset", "0 m"), "hover: sideways RMS error"):at_most "10 cm"
end

local function land(t)
  t:command { land = true }
  t:within("10 s", function(s) return s.told_armed == 0 end, "landed and disarmed")
  t:wait "4 s" -- the log is closed three seconds after disarming
end

-- No sample is missing that the log does not own up to.
local function whole(t, log)
  t:expect(log:damaged()):equal "0"
  for _, topic in ipairs(fast) do
    t:expect(log:gap(topic)):at_most "7.5 ms"
  end
end

log_plan("a flight is logged whole", { "quick", "flight", "log" }, function(t)
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  t:wait "3 s"
  t:expect(t:value "told_logging", "the card is there"):equal "1"
  undisturbed(t, "25 s")
  t:command { arm = true }
  t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
  t:wait "1 s"
  local flight = t:record(held, "20 s", function() t:command { takeoff = "1.1 m" } end)
  t:command { position = { north = "50 cm", east = "-30 cm", height = "1.3 m" } }
  local step = t:record(held, "4 s")
  land(t)

  local log = t:flight_log("card")
  t:expect(log:closed()):equal "1"
  whole(t, log)
  t:expect(log:dropouts()):equal "0 ms"
  t:expect(log:says "commanded"):equal "1"
  t:expect(log:says "landed"):equal "1"
  for _, during in ipairs { flight, step } do
    -- What the radio told stands in the log to the last digit.
    t:expect(log:untold(during)):equal "0"
    -- What is estimated is not the truth; limits are those of a hover's errors and of the sensors.
    for _, signal in ipairs { "height", "north", "east" } do
      t:expect(log:error(during, signal)):at_most "5 cm"
    end
    for _, signal in ipairs { "climb", "velocity_north", "velocity_east" } do
      t:expect(log:error(during, signal)):at_most "20 cm/s"
    end
    t:expect(log:error(during, "yaw")):at_most "3 deg"
  end
end)

-- The log of a flight that something befell: it may lack the last second, and no more.
local function until_then(t, log, when_s)
  t:expect(log:closed()):equal "0"
  whole(t, log)
  t:expect(log:last "vehicle_attitude"):at_least(string.format("%.3f s", when_s - 1))
end

-- Half a written block, then no supply for two seconds. What the card had until then stays, and the log
-- goes on in a second file.
log_plan("a card that loses its supply in a write keeps all but the last second", { "quick", "flight", "log" },
function(t)
  hover(t)
  undisturbed(t, "8 s")
  local before = t:record(held, "3 s")
  t:wait "1 s"
  local cut_s = t:now().value
  t:fault { kind = "memory_cut", device = "card", duration = "2 s" }
  steady(t, "5 s")
  land(t)
  local first, second = t:flight_log("card", 1), t:flight_log("card", 2)
  until_then(t, first, cut_s)
  t:expect(first:untold(before)):equal "0"
  t:expect(second:closed()):equal "1"
  whole(t, second)
  -- Two seconds without a card, a quarter until it is tried again, then a file is opened.
  t:expect(second:first "vehicle_attitude"):at_most(string.format("%.3f s", cut_s + 4))
end)

log_plan("a card that is pulled out and put back gets a new log", { "flight", "log" }, function(t)
  hover(t)
  undisturbed(t, "10 s")
  t:wait "2 s"
  local pulled_s = t:now().value
  t:fault { kind = "memory_removed", device = "card", duration = "3 s" }
  t:within("1.5 s", function(s) return s.told_logging == 0 end, "it is told")
  t:wait "3 s"
  steady(t, "5 s")
  t:expect(t:value "told_logging", "it is well again"):equal "1"
  land(t)
  until_then(t, t:flight_log("card", 1), pulled_s)
  local second = t:flight_log("card", 2)
  t:expect(second:closed()):equal "1"
  whole(t, second)
end)

-- Three pauses of 0.55 s with 10 ms between them: the buffer holds 0.6 s.
log_plan("a card that answers late costs samples, and the log says which", { "flight", "log" }, function(t)
  hover(t)
  undisturbed(t, "8 s")
  for i = 0, 3 do
    t:fault { kind = "memory_busy", device = "card", start = string.format("%d ms", 1000 + 560 * i), duration = "550 ms" }
  end
  steady(t, "6 s")
  land(t)
  local log = t:flight_log("card")
  t:expect(log:closed()):equal "1"
  whole(t, log)
  t:expect(log:dropouts()):within("100 ms", "2.5 s")
end)

-- The card says that it has not written, or that what came was spoiled on the wire, for a second: what was in
-- hand is written again or owned up to, and nothing else is lost.
for _, f in ipairs {
  { kind = "memory_write_error", device = "card" }, { kind = "memory_crc_error", device = "card" }, { kind = "spi_silent", device = "card" },
} do
  log_plan("a card whose blocks fail for a second is written on: " .. f.kind, { "flight", "log" }, function(t)
    hover(t)
    undisturbed(t, "8 s")
    t:fault { kind = f.kind, device = f.device, start = "1 s", duration = "1 s" }
    steady(t, "6 s")
    land(t)
    t:expect(t:value "told_logging", "it is well again"):equal "1"
    local log = t:flight_log("card")
    t:expect(log:closed()):equal "1"
    whole(t, log)
    t:expect(log:dropouts()):at_most "2.5 s"
  end)
end

log_plan("without a card it flies as ever", { "flight", "log" }, function(t)
  t:fault { kind = "memory_removed", device = "card" }
  hover(t)
  undisturbed(t, "5 s")
  t:expect(t:value "told_logging", "it is told"):equal "0"
  steady(t, "5 s")
  land(t)
end)

-- The microcontroller falls silent in the middle of a flight, and with it the log; the next one gets a new file.
log_plan("a reset in flight leaves the log until then", { "flight", "log" }, function(t)
  hover(t)
  t:wait "2 s"
  local reset_s = t:now().value
  t:fault { kind = "reset_pin" }
  t:within("3 s", function(s) return s.told_armed == 0 end, "it has begun anew")
  t:wait "2 s"
  until_then(t, t:flight_log("card", 1), reset_s)
  t:expect(t:value "told_logging", "the card is there again"):equal "1"
end)

-- One MiB, found after some seconds, holds 40 s of flight. The log ends where the card does; the flight
-- does not.
log_plan("a card that runs full ends its log and nothing else", { "flight", "log" }, function(t)
  hover(t)
  undisturbed(t, "50 s")
  t:wait "5 s"
  local before = t:record(held, "10 s")
  t:within("40 s", function(s) return s.told_logging == 0 end, "it is told")
  steady(t, "10 s")
  land(t)
  local log = t:flight_log("card")
  whole(t, log)
  t:expect(log:dropouts()):equal "0 ms"
  t:expect(log:untold(before)):equal "0"
  t:expect(t:value "told_logging", "there is no other log"):equal "0"
end, "px4fmu_v1_full_card")
