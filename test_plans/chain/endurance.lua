-- Half an hour in the air, flown by five unmodified images: six times five minutes, of which four are a hover and one a figure 8
-- with the way there and back. Each five minutes are judged by the same limits, so what grows is seen. It takes hours:
-- `whirl run --tag endurance` (or this file) flies it; neither the quick plans nor the nightly ones have it. `chain endurance,
-- first minute` is the same script for one minute and a half, and nightly, so that the long one does not rot between its flights.
include "include/chain.lua"
include "include/flights.lua"

-- The thesis's figure 8 by what it asks, 5 cm of position: figure_8.lua beside this judges it closer, once. Here a part is not
-- to be worse than another one, and a copy's six rounds have its worst.
local function target_is_flown(t, name)
  t:command { position = { north = "1 m" }, speed = "0.5 m/s" }
  t:wait "6 s"
  t:command { figure_8 = {} }
  t:wait "5 s"
  local r = t:record({ "path_error", "north", "east", "height" }, "20 s")
  t:expect(r:rms "path_error", name .. "RMS of the error of position"):at_most "5 cm"
  t:expect(r:max "path_error", name .. "largest error of position"):at_most "10 cm"
  t:expect(r:max "north", name .. "to the north"):within("0.95 m", "1.05 m")
  t:expect(r:min "east", name .. "to the west"):within("-1.05 m", "-0.95 m")
  t:expect(r:rms_error("height", "1.1 m"), name .. "height RMS error on the target's way"):at_most "1 cm"
  t:command { position = { north = "0 m", height = "1.1 m" }, speed = "0.5 m/s" }
  t:wait "9 s"
end

-- A hover of that length, 40 s of the target's way, and what the five have kept of the energy so far. Gives its height's and its sideways RMS error, in m.
local function part(t, boards, name, hover)
  local r = t:record({ "height", "offset", "tilt", "bus_voltage" }, hover)
  local height, sideways = r:rms_error("height", "1.1 m"), r:rms_error("offset", "0 m")
  t:expect(height, name .. "height RMS error"):at_most "1 cm"
  t:expect(sideways, name .. "sideways RMS error"):at_most "4 cm"
  t:expect(r:max "tilt", name .. "tilt"):at_most "5 deg"
  target_is_flown(t, name)
  if boards then judged_energy(t, name) end
  t:log(string.format("%sheight %.2f mm, sideways %.2f mm RMS, %.3f V", name, 1e3 * height.value, 1e3 * sideways.value,
    r:mean("bus_voltage").value))
  return height.value, sideways.value
end

local function endures(t, boards, parts, hover)
  t:step "take-off"
  hovers(t)
  t:wait "3 s" -- what the climb leaves
  for _, esc in ipairs(escs) do -- to the end: each is asked in time, and acknowledges
    t:bus { device = "flight/" .. esc, direction = "write", period = "20 ms", tolerance = "0.5 ms" }
    t:bus { device = "flight/" .. esc, direction = "read", period = "50 ms", tolerance = "1 ms" }
  end
  local heights, sideways = {}, {}
  for n = 1, parts do
    local name = string.format("part %d: ", n)
    t:step(string.format("part %d of %d", n, parts))
    heights[n], sideways[n] = part(t, boards, name, hover)
  end
  -- Each part has the same noise over the same minutes: half as much again is more than chance.
  if parts > 1 then
    t:expect(heights[parts] / heights[1], "height RMS error, the last part's of the first's"):at_most(1.5)
    t:expect(sideways[parts] / sideways[1], "sideways RMS error, the last part's of the first's"):at_most(1.5)
  end
end

-- 40 s of each five minutes are the target's; the landing, with some 20 s before the first part, ends beyond the thirty.
chain_plan("chain endurance", { vehicle = "hp_quad_30_min", tags = { "endurance" }, timeout = "1860 s", parity = true }, function(t, boards)
  endures(t, boards, 6, "260 s")
  -- As ten minutes of flight/endurance.lua: a pack at 42 % of what it holds. So it was there all the time, and not a still picture.
  t:expect(t:value "bus_voltage", "the pack after thirty minutes"):within("14.5 V", "15 V")
  t:expect(t:value "charge_used", "charge used"):within("2.5 Ah", "3.2 Ah")
  lands(t)
end)

chain_plan("chain endurance, first minute", { vehicle = "hp_quad_30_min", timeout = "120 s" }, function(t, boards)
  endures(t, boards, 1, "20 s")
  lands(t)
end)
