-- The drag coefficient that the vehicle finds in flight, held against the plant's forces: signal drag_s_per_m, what
-- blades and rotor_drag_s_per_m give together at the speeds flown. Nobody tells the image its vehicle: all start from
-- the thesis's 0.04 s/m.
include "include/hover.lua"

local function judge(t, way, length)
  local own, told = t:value("drag_s_per_m").value, t:value("told_drag_s_per_m").value
  local sigma = t:value("told_drag_sigma_s_per_m").value
  t:log(string.format("%s, %s: %.4f s/m of %.4f (%+.1f %%), told sigma %.4f", way, length, told, own,
                      100 * (told / own - 1), sigma))
  t:expect(t:value "drag_s_per_m", way .. ": the vehicle's own"):within(0.02, 0.06)
  t:expect(math.abs(told / own - 1), way .. ": off by this share, after " .. length):at_most(0.05)
  t:expect(sigma / told, way .. ": told sigma, as a share"):at_most(0.03)
end

local function figure_8(t)
  t:step "to the figure 8"
  t:command { position = { north = "1 m" } }
  t:within("5 s", function(s) return s.path_error_m < 0.15 end, "at its start")
  t:wait "1 s"
  t:step "one round"
  t:command { figure_8 = {} }
  t:wait "20 s"
  judge(t, "figure 8", "20 s")
end

local function legs(t)
  t:step "to and fro"
  t:command { velocity = { north = "0.6 m/s" } }
  t:wait "1.5 s"
  for _, speed in ipairs { "-0.6 m/s", "0.6 m/s", "-0.6 m/s", "0.6 m/s", "-0.6 m/s", "0.6 m/s" } do
    t:command { velocity = { north = speed } }
    t:wait "3 s"
  end
  judge(t, "velocity legs", "19.5 s")
end

-- `blades`: what the rotors' blades lack; with the blade elements' 0.007 that is the coefficient.
local function identification(name, blades, wind, fly)
  plan("drag_identification_" .. name) {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad", vehicle_with = { rotor_drag_s_per_m = blades },
    tags = { "flight", "drag" }, timeout = "90 s",
    run = function(t)
      hover(t)
      if wind then
        t:gust { north = "1.8 m/s", east = "-0.9 m/s", duration = "80 s", edge = "2 s" }
        t:wait "4 s"
      end
      t:expect(t:value "told_drag_s_per_m", "before: the thesis's"):within(0.0385, 0.0415)
      fly(t)
    end,
  }
end

for name, blades in pairs { ["028"] = 0.021, ["034"] = 0.027, ["040"] = 0.033, ["046"] = 0.039, ["052"] = 0.045 } do
  identification(name .. "_calm", blades, false, figure_8)
  identification(name .. "_wind", blades, true, figure_8)
end
identification("028_legs", 0.021, false, legs)
identification("052_legs", 0.045, true, legs)
