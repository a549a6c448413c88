-- The supply sags: a short dip that leaves enough is ridden out, one below 12 V switches off and latches.
include "include/start.lua"

local function dip_plan(name, run)
  plan(name) {
    image = "esc", board = "esc32v2",
    stand = { prop = "hk_10x4.5", battery = "4s_2200" },
    tags = { "esc", "faults" },
    timeout = "20 s",
    run = run,
  }
end

dip_plan("supply_dip_3v", function(t)
  start(t, "2 N")
  t:step "dip"
  local dip = t:record({ "thrust", "winding_peak", "bus_peak", "bus_voltage" }, "1 s", function()
    t:fault { kind = "supply_dip", value = "3 V", duration = "200 ms" }
  end)
  t:expect(dip:min "bus_voltage", "the dip arrives"):at_most "14 V"
  t:expect(dip:min "thrust", "lowest thrust"):at_least "1.6 N"
  t:expect(dip:max "thrust", "highest thrust"):at_most "2.6 N"
  safe(t, dip)
  t:expect(t:value "armed", "still armed"):equal(1)
end)

dip_plan("supply_dip_6v", function(t)
  start(t, "2 N")
  t:step "dip"
  local dip = t:record({ "winding_peak", "bus_peak" }, "300 ms", function()
    t:fault { kind = "supply_dip", value = "6 V", duration = "300 ms" }
  end)
  safe(t, dip)
  t:step "latched"
  local off = t:record({ "winding_peak" }, "500 ms")
  t:expect(off:max "winding_peak", "winding current, latched"):at_most "0.1 A"
  t:expect(t:value "armed", "disarmed"):equal(0)
  t:within("10 ms", function(s) return flag(s.esc_flags, 4) end, "told as under-voltage")
end)
