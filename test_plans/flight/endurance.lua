-- Ten minutes of hover on one pack of 2200 mAh: the sag of Fig 2.11 in the thesis, 16.4-16.8 V at first
-- and 14.5-15 V in the end.
include "include/hover.lua"

plan "endurance" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "nightly", "flight" }, timeout = "650 s",
  run = function(t)
    t:step "hover"
    hover(t)
    t:always("height, from 1.05 m to 1.15 m", function(s) return math.abs(s.height_m - 1.1) < 0.05 end)
    local fresh = t:record({ "bus_voltage", "bus_current_1" }, "10 s")
    t:expect(fresh:mean "bus_voltage", "fresh"):within("15.9 V", "16.8 V")
    t:step "ten minutes"
    t:wait "580 s"
    local tired = t:record({ "bus_voltage", "height", "charge_used", "battery_current" }, "10 s")
    t:expect(tired:mean "bus_voltage", "after ten minutes"):within("14.5 V", "15 V")
    t:expect(tired:rms_error("height", "1.1 m"), "height RMS error at the end"):at_most "5 cm"
    t:log(string.format("%.2f V at first, %.2f V and %.2f A after ten minutes, %.0f C used",
      fresh:mean("bus_voltage").value, tired:mean("bus_voltage").value,
      tired:mean("battery_current").value, tired:final("charge_used").value))
  end,
}
