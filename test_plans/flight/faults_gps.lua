-- Faults of a GPS receiver in mid-hover outdoors, and on the ground: what is noticed, and that the vehicle does not
-- fly away. Without a position the image lands by vertical speed alone, so that what is asked of it then is to come
-- down near by.
include "include/gps.lua"
include "include/gps_faults.lua"
include "include/moment.lua"

local function gps_plan(name, run) gps_fault_plan("px4fmu_v1", name, run) end

gps_plan("gps: one solution in three lost is flown through", function(t)
  hover_by_gps(t)
  some_moment(t)
  t:fault { kind = "gnss_dropout", device = "gps", value = 0.3, duration = "20 s" }
  local r = t:record({ "receiver_north", "receiver_east", "told_state" }, "20 s")
  t:expect(r:max "told_state", "it flies on"):at_most(2)
  t:expect(r:rms_error { receiver_north = "0 m", receiver_east = "0 m" }, "RMS distance, by its receiver"):at_most "0.8 m"
end)

-- Of the line from the receiver: what fails its checksum is no solution.
for _, f in ipairs {
  { name = "gps: one byte in two thousand lost is flown through", kind = "uart_loss", device = "gps", value = 0.0005 },
  { name = "gps: one byte in two thousand with a flipped bit is flown through", kind = "uart_flip", device = "gps", value = 0.0005 },
  { name = "gps: solutions that come 100 ms later are flown through", kind = "sensor_late", device = "gps", value = "100 ms" },
} do
  gps_plan(f.name, function(t)
    hover_by_gps(t)
    some_moment(t)
    t:fault { kind = f.kind, device = f.device, value = f.value, duration = "20 s" }
    local r = t:record({ "receiver_north", "receiver_east", "told_state" }, "20 s")
    t:expect(r:max "told_state", "it flies on"):at_most(2)
    t:expect(r:rms_error { receiver_north = "0 m", receiver_east = "0 m" }, "RMS distance, by its receiver"):at_most "0.8 m"
  end)
end

gps_plan("gps: a receiver that is not heard any more ends the flight", function(t)
  hover_by_gps(t)
  some_moment(t)
  t:fault { kind = "uart_silence", device = "gps" }
  comes_down(t)
end)

gps_plan("gps: no solutions any more end the flight", function(t)
  hover_by_gps(t)
  some_moment(t)
  t:fault { kind = "gnss_dropout", device = "gps", value = 1 }
  comes_down(t)
end)

gps_plan("gps: a jammed receiver ends the flight", function(t)
  hover_by_gps(t)
  some_moment(t)
  t:fault { kind = "gnss_jammed", device = "gps" }
  comes_down(t)
end)

gps_plan("gps: a jump of 15 m is noticed and not followed", function(t)
  noticed(t, { kind = "sensor_offset", device = "gps", axis = "north", value = "15 m" })
end)

gps_plan("gps: a velocity that is 3 m/s off is noticed and not followed", function(t)
  noticed(t, { kind = "sensor_offset", device = "gps", axis = "velocity_east", value = "3 m/s" })
end)

gps_plan("gps: a place that runs away at 3 m/s is noticed", function(t)
  noticed(t, { kind = "gnss_spoofed", device = "gps", axis = "east", value = "3 m/s" })
end)

-- What cannot be noticed: no sensor on board tells it from wind. The vehicle goes along, no faster.
gps_plan("gps: a place that drifts at 0.3 m/s carries the vehicle along", function(t)
  hover_by_gps(t)
  some_moment(t)
  t:fault { kind = "gnss_spoofed", device = "gps", axis = "east", value = "0.3 m/s", duration = "20 s" }
  local r = t:record({ "receiver_north", "receiver_east", "told_state" }, "20 s")
  t:expect(r:max "told_state", "it flies on"):at_most(2)
  t:expect(r:rms_error { receiver_north = "0 m", receiver_east = "0 m" }, "RMS distance, by its receiver"):at_most "0.8 m"
end)

-- The same place and velocity again and again: believed it would be hovered by, and the wind take the vehicle along.
gps_plan("gps: a receiver that has stopped measuring ends the flight", function(t)
  noticed(t, { kind = "sensor_frozen", device = "gps" })
end)

gps_plan("gps: a receiver that begins anew on the ground is found again", function(t)
  arm_by_gps(t)
  t:command { arm = false }
  t:within("4 s", function(s) return s.told_armed == 0 end, "disarmed")
  t:fault { kind = "gnss_brown_out", device = "gps" }
  t:wait "25 s" -- silence 2 s, search, a hot start, and its errors settle again
  t:command { arm = true }
  t:within("10 s", function(s) return s.told_armed == 1 end, "armed")
end)

gps_plan("gps: a receiver that begins anew in flight is found again", function(t)
  found_again_in_flight(t, { kind = "gnss_brown_out", device = "gps" })
end)

-- Its rate is 1 Hz and its model that of a hand-held one from then on: nothing fails, and fixes would be too few for good. What
-- it was told is polled, each setting within 10 s, and told again.
gps_plan("gps: a receiver that forgets its rate in flight is told it again", function(t)
  forgets_in_flight(t, { kind = "gnss_forgets", device = "gps" })
end)
