-- Both controllers of thrust in a wind along the shaft, judged by what power can tell: downdraft.lua says how the limits
-- came about.

-- From here on it can be told by the bound, and must be told: m/s, by thrust in N
kBound = { ["2.4"] = 3.2, ["3.2"] = 3.4, ["4.0"] = 3.6 }
kTold = { ["2.4"] = 4.2, ["3.2"] = 3.8, ["4.0"] = 4.0 }
local kMeasured = "1 s"

-- From rest: zero found, calm start, then the wind; errors and sensitivity of one point. how: { volts, warm(t, for) }.
function point(t, verb, thrust_N, wind_mps, how)
  how = how or {}
  if how.warm then how.warm(t, "10 s") end
  t:ask("stop", "^ok$")
  t:wait_until(function(s) return s.speed_radps < 5 end, "5 s")
  t:wait "1 s"
  t:ask("arm", "^ok$")
  t:ask(string.format("%s %.1f", verb, thrust_N), "^ok$")
  t:wait "300 ms"
  if how.volts then
    local lacks_V = t:value("bus_voltage", "V") - how.volts
    if lacks_V > 0.1 then t:fault { kind = "supply_dip", value = lacks_V .. " V", duration = "2700 ms" } end
  end
  t:wait "600 ms"
  t:gust { down = wind_mps .. " m/s", edge = "300 ms" }
  t:wait "1 s"
  local r = t:record({ "thrust", "speed", "esc_observable", "esc_iterations", "esc_thrust" }, kMeasured)
  local told = t:ask("inflow", "^ls ")
  t:gust { down = "0 m/s", edge = "300 ms" }
  local mean, rms = r:mean("thrust").value, r:rms("thrust").value
  return {
    error = 100 * (mean / thrust_N - 1), sigma = 100 * math.sqrt(math.max(0, rms * rms - mean * mean)) / thrust_N,
    speed = r:mean("speed").value, seen = r:mean("esc_observable").value, iterations = r:max("esc_iterations").value,
    believed = 100 * (r:mean("esc_thrust").value / thrust_N - 1),
    mN_per_mA = tonumber(told:match "N/A (%S+)"), slope = tonumber(told:match "slope (%S+)"),
    leverage = tonumber(told:match "leverage (%S+)"),
  }
end

-- One line of the table: both controllers at one wind, judged by what can be told from `told_mps` on.
function compared(t, at, thrust_N, wind, told_mps, how)
  t:step(at .. "RPM controller")
  local rpm = point(t, "thrust", thrust_N, wind, how)
  t:step(at .. "power-based")
  local power = point(t, "st", thrust_N, wind, how)
  t:log(string.format("%sRPM %+.2f %% (sigma %.2f), power %+.2f %% (sigma %.2f) at %.0f rpm; dT/dmA %.2f mN, dCP/dls %.3g, leverage %.2f, seen %.2f, iterations %d, believes %+.2f %%",
    at, rpm.error, rpm.sigma, power.error, power.sigma, power.speed * 9.5493, power.mN_per_mA, power.slope, power.leverage,
    power.seen, power.iterations, power.believed))
  t:expect(power.iterations, at .. "iterations of Algorithm 1"):at_most(6)
  -- About the bound it may see it, or not, or begin to in this very second.
  local edge = wind >= kBound[string.format("%.1f", thrust_N)] - 0.4 and wind < told_mps
  if not edge then t:expect(power.sigma, at .. "sigma of thrust in %"):at_most(1) end
  if wind >= told_mps then
    t:expect(math.abs(power.error), at .. "error in % of the power-based controller"):at_most(math.abs(rpm.error) / 3)
    t:expect(power.seen, at .. "share of the time that power determines inflow"):at_least(0.99)
    t:expect(-rpm.error, at .. "loss of the RPM controller in %"):at_least(3.5 * wind)
  else
    t:expect(math.abs(power.error) - math.abs(rpm.error), at .. "worse than the RPM controller, %"):at_most(1)
  end
end
