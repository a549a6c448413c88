-- A fault of a sensor in a hover, 2 s long where it does not say: flown through, and after 10 s all is as before.
-- Meanwhile the barometer's height goes nowhere: three times the 20 cm that it is held to, or `baro` where the
-- fault is one that is believed.
function judged_sensor_fault(t, f)
  t:fault { kind = f.kind, device = f.device, bus = f.bus, axis = f.axis, value = f.value, duration = f.duration or "2 s" }
  local r = t:record({ "height", "offset", "attitude_error", "baro_height_error" }, "4 s")
  t:expect(r:rms_error("height", "1.1 m"), "height RMS error"):at_most "5 cm"
  t:expect(r:rms "offset", "sideways RMS error"):at_most "10 cm"
  t:expect(r:max "attitude_error", "attitude that is flown by"):at_most "3 deg"
  t:expect(r:max_error("baro_height_error", "0 m"), "height by the barometer meanwhile"):at_most(f.baro or "60 cm")
  t:wait "8 s"
  local after = t:record({ "baro_height_error", "baro_climb_error", "attitude_error_1" }, "2 s")
  t:expect(after:rms "baro_height_error", "after 10 s: height by the barometer"):at_most "20 cm"
  t:expect(after:rms "baro_climb_error", "after 10 s: climb by the barometer"):at_most "0.15 m/s"
  t:expect(after:rms "attitude_error_1", "after 10 s: attitude of filter 1"):at_most "3 deg"
end
