-- Wind as the difference between velocity over ground and through the air (filters 1 and 2; thesis, section
-- 6.2): 3 m/s, then 2 m/s more. The vehicle first finds its drag coefficient by one round of the figure 8; it is
-- another one in each plan, and nobody tells it.
include "include/hover.lua"

local function names_of(signal)
  local names = {}
  for motor = 1, 4 do names[motor] = signal .. "_" .. motor end
  return names
end

-- Blades bend up by lift's moment over the root's stiffness and the mass's (1.1 N at 0.6 to 0.8 of 12.7 cm over 64 N m/rad), and
-- the discs tilt away from a wind from behind, 0.07 mrad for each m/s as flown; asked is the sense, and a tenth of it (harness/flight/tests/flight_world_test.cpp).
local function judge_discs(t, record)
  for motor, cone in ipairs(names_of "flapping_cone") do
    t:expect(record:mean(cone), "cone of motor " .. motor):within("0.0011 rad", "0.0025 rad")
  end
  for motor, back in ipairs(names_of "flapping_back") do
    t:expect(record:mean(back), "tilt back of the disc of motor " .. motor):at_most "-0.00002 rad"
  end
end

local function wind_estimate(name, blades, tags)
  plan("wind_estimate" .. name) {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad", vehicle_with = { rotor_drag_s_per_m = blades },
    tags = tags, timeout = "120 s",
    run = function(t)
      hover(t)
      t:step "finds its drag"
      t:command { position = { north = "1 m" } }
      t:within("5 s", function(s) return s.path_error_m < 0.15 end, "at the figure's start")
      t:command { figure_8 = {} }
      t:wait "20 s"
      t:command { position = { north = "0 m", east = "0 m" } }
      t:wait "5 s"
      t:step "3 m/s from the south"
      t:gust { north = "3 m/s", duration = "60 s", edge = "2 s" }
      t:wait "15 s"
      local signals = { "wind_error_north", "wind_error_east", "attitude_error_1", "attitude_error_2", "offset" }
      for _, signal in ipairs { "flapping_cone", "flapping_back" } do
        for _, one in ipairs(names_of(signal)) do table.insert(signals, one) end
      end
      local steady = t:record(signals, "10 s")
      judge_discs(t, steady)
      t:expect(steady:rms_error { wind_error_north = "0 m/s", wind_error_east = "0 m/s" }, "steady: RMS error"):at_most "0.3 m/s"
      t:expect(steady:rms "attitude_error_2", "attitude of filter 2"):at_most "1 deg"
      t:expect(steady:rms "offset", "off the place"):at_most "10 cm"
      t:step "and 2 m/s from the west"
      t:gust { east = "2 m/s", duration = "40 s", edge = "500 ms" }
      t:wait "10 s"
      local changed = t:record({ "wind_error_north", "wind_error_east" }, "10 s")
      t:expect(changed:max_error { wind_error_north = "0 m/s", wind_error_east = "0 m/s" }, "10 s after the change: largest error"):at_most "0.3 m/s"
    end,
  }
end

-- The vehicle's file, and coefficients of 9 % and 25 % more and less than the thesis's 0.04: without the 0.007 that
-- come from the blade elements.
wind_estimate("", 0.033, { "flight" })
wind_estimate("_drag_9_more", 0.0366, { "flight", "drag" })
wind_estimate("_drag_9_less", 0.0294, { "flight", "drag" })
wind_estimate("_drag_25_more", 0.043, { "flight", "drag" })
wind_estimate("_drag_25_less", 0.023, { "flight", "drag" })
