-- The flight of gps.lua with a NEO-M8: the image finds out by itself what it talks to, and takes NAV-PVT in place of the
-- three messages of a LEA-6. The same limits; and each fault of the receiver once more, for its solutions come
-- in by another way.
include "include/gps.lua"
include "include/gps_faults.lua"
include "include/moment.lua"
include "include/judged_gps.lua"

local board = "px4fmu_v1_m8"

plan "gps m8" {
  image = "flight", board = board, vehicle = "hp_quad",
  tags = { "flight" }, timeout = "300 s",
  outdoors = true, air = wind, fence = { radius = "40 m", height = "20 m" },
  run = function(t)
    t:step "cold start"
    arm_by_gps(t)
    t:budget("fw::gps_task") { execution = "200 us", response = "500 us", margin = "10 %" }
    judged_gps(t)
  end,
}

local function m8_plan(name, run) gps_fault_plan(board, "gps m8: " .. name, run) end

m8_plan("what spoils a few solutions is flown through, jamming ends the flight", function(t)
  hover_by_gps(t)
  some_moment(t)
  local few = {
    { kind = "gnss_dropout", device = "m8", value = 0.3, duration = "10 s" },
    { kind = "uart_loss", device = "m8", value = 0.0005, duration = "10 s" },
    { kind = "uart_flip", device = "m8", value = 0.0005, duration = "10 s" },
    { kind = "sensor_late", device = "m8", value = "100 ms", duration = "10 s" },
  }
  for _, fault in ipairs(few) do
    t:fault(fault)
    local r = t:record({ "receiver_north", "receiver_east", "told_state" }, "10 s")
    t:expect(r:max "told_state", fault.kind .. ": it flies on"):at_most(2)
    -- As faults_gps.lua asks of twenty seconds.
    t:expect(r:rms_error { receiver_north = "0 m", receiver_east = "0 m" }, fault.kind .. ": RMS distance, by its receiver"):at_most "0.8 m"
  end
  t:fault { kind = "gnss_jammed", device = "m8" }
  comes_down(t)
end)

local ends = {
  { "a jump of 15 m", { kind = "sensor_offset", device = "m8", axis = "north", value = "15 m" } },
  { "a velocity that is 3 m/s off", { kind = "sensor_offset", device = "m8", axis = "velocity_east", value = "3 m/s" } },
  { "a place that runs away at 3 m/s", { kind = "gnss_spoofed", device = "m8", axis = "east", value = "3 m/s" } },
  { "a receiver that has stopped measuring", { kind = "sensor_frozen", device = "m8" } },
}
for _, e in ipairs(ends) do
  m8_plan(e[1] .. " ends the flight", function(t) noticed(t, e[2]) end)
end

m8_plan("one that begins anew in flight is found again", function(t)
  found_again_in_flight(t, { kind = "gnss_brown_out", device = "m8" })
end)

m8_plan("a receiver that forgets its rate in flight is told it again", function(t)
  forgets_in_flight(t, { kind = "gnss_forgets", device = "m8" })
end)
