-- Faults that a sound flight survives without leaving its place: single bits, late answers, short
-- silences, a sagging supply. What the image must do about lasting ones is in faults.lua.
include "include/hover.lua"
include "include/moment.lua"

-- The vehicle stays where it was while `fault` acts and for a second more. refused: how many set-points the ESCs throw
-- away meanwhile.
local function unmoved(name, fault, height, refused)
  plan(name) {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
    tags = { "quick", "flight", "faults" }, timeout = "60 s",
    run = function(t)
      hover(t)
      some_moment(t)
      local before = t:value "setpoints_refused"
      local record = t:record({ "height", "offset", "tilt", "setpoints_refused" }, "2 s", function() t:fault(fault) end)
      local thrown_away = record:final("setpoints_refused").value - before.value
      if refused then
        t:expect(thrown_away, name .. ": set-points refused"):within(refused[1], refused[2])
      else
        t:expect(thrown_away, name .. ": set-points refused"):equal(0)
      end
      t:expect(record:max "height", name .. ": highest"):at_most(height.most)
      t:expect(record:min "height", name .. ": lowest"):at_least(height.least)
      t:expect(record:max "tilt", name .. ": tilt"):at_most "10 deg"
      t:expect(record:max "offset", name .. ": sideways"):at_most "20 cm"
    end,
  }
end

local still = { most = "1.2 m", least = "1.0 m" }
unmoved("an ESC that hears nothing for 100 ms",
        { kind = "i2c_silence", device = "esc3", duration = "100 ms" }, still)
unmoved("set-points with a flipped bit for 100 ms are refused by their CRC",
        { kind = "i2c_flip_bit", device = "esc1", duration = "100 ms", value = 3 }, still, { 5, 6 })
unmoved("an ESC that stretches the clock by 200 us",
        { kind = "i2c_late", device = "esc4", duration = "1 s", value = "200 us" }, still)
unmoved("SCL held low for 50 ms", { kind = "i2c_stuck_scl", bus = "i2c3", duration = "50 ms" }, still)
unmoved("the supply dips by 3 V for half a second",
        { kind = "supply_dip", duration = "500 ms", value = "3 V" }, { most = "1.2 m", least = "0.9 m" })
