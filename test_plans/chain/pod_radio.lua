-- The flight image's telemetry radio and its battery are the pod's too, beside its sensors and ESCs: nothing but the radio arms
-- it and tells where it is, and what it tells of its battery came as a level to its analog pin. Two resistors of 1 % make
-- 1.7 % of 16 V, the steps of DAC and converter 0.01 V, the telemetry's age some more: 0.35 V.
include "include/flights.lua"
include "include/pod.lua"

local more = {
  { from = "flight.radio", to = "pod.usart3", fastest = "57600 baud" },
  { from = "flight.battery", to = "pod.dac1", latency = "100 us" },
}

local function radio_plan(name, run)
  pod_plan(name, function(t)
    hovers(t, "5 s")
    run(t)
  end, "pod_with_radio", more)
end

local function told_voltage(t, name)
  local told, true_V = t:value("told_voltage").value, t:value("bus_voltage").value
  t:expect(math.abs(told - true_V), name .. ": what it tells of its battery is off by, V"):at_most(0.35)
end

radio_plan("pod radio and battery", function(t)
  local hover = t:record({ "height", "offset", "tilt" }, "5 s")
  t:expect(hover:rms_error("height", "1.1 m"), "hover: height RMS error"):at_most "5 cm"
  t:expect(hover:rms_error("offset", "0 m"), "hover: sideways RMS error"):at_most "10 cm"
  t:expect(hover:rms "tilt", "hover: tilt RMS"):at_most "3 deg"
  told_voltage(t, "hovering")
  nothing_late(t)
  t:expect(figure(t, "pod_radio_dropped"), "pieces for which the radio's line had no room"):equal(0)
  lands(t)
end)

radio_plan("pod battery sags", function(t)
  t:fault { kind = "supply_dip", value = "3.4 V" }
  t:told("6 s", "battery empty")
  told_voltage(t, "sagging")
  t:within("20 s", function(s) return s.on_ground == 1 end, "on the ground")
end)

radio_plan("pod radio's wire is cut", function(t)
  t:fault { kind = "uart_silence", bus = "pod/usart3" }
  t:within("20 s", function(s) return s.on_ground == 1 end, "on the ground")
  t:within("5 s", function(s) return each_rotor(s, "speed_", "_radps", 5) end, "no rotor turns")
end)
