-- Steps of thrust on a full, a used and a nearly empty pack, and with more and less inertia. What a supply lacks
-- below 15.7 V is taken from it once the rotor turns. How long 20 A alone would take from 0.8 to 4.0 N is computed
-- here, from the stand's own inertia and motor and from the torque that it shows at both ends.
-- The power-based controller: rise_by_power.lua; open loop: open_loop.lua.
-- The ESC is calibrated: until then it leaves a tenth of its current.
include "include/start.lua"
include "include/calibration.lua"

local inertia_kgm2 = 3.752e-5
local kv_rpm_per_V = 950
local no_load_A = 1
local limit_A = 20

-- Seconds from 10 to 90 % of the thrust between two steady points { w, torque, thrust }, with the limit's torque.
local function bound_s(low, high, inertia)
  local Kt = 30 / (3.14159265358979 * kv_rpm_per_V)
  -- Thrust and torque go as a w^2 + b w through both points.
  local function through(key)
    local a = (high[key] / high.w - low[key] / low.w) / (high.w - low.w)
    local b = low[key] / low.w - a * low.w
    return function(w) return a * w * w + b * w end
  end
  local thrust, torque = through "thrust", through "torque"
  local at = function(share) return low.thrust + share * (high.thrust - low.thrust) end
  local w, t, dt = low.w, 0, 2e-5
  local from
  while thrust(w) < at(0.9) do
    if not from and thrust(w) >= at(0.1) then from = t end
    w = w + dt / inertia * (Kt * (limit_A - no_load_A) - torque(w))
    t = t + dt
  end
  return t - (from or t)
end

local function point(t)
  return { w = t:value("speed", "rad/s"), torque = t:value("torque", "N m"), thrust = t:value("thrust", "N") }
end

local signals = { "thrust", "winding_peak", "bus_peak" }

local function small_steps(t)
  t:step "fall"
  local fall = t:record(signals, "1 s", function() t:command { thrust = "2 N" } end)
  t:expect(fall:final "thrust", "thrust after the fall"):within("1.9 N", "2.2 N")
  t:expect(fall:fall_time "thrust", "thrust fall 3.2 to 2.0 N"):at_most "70 ms"
  safe(t, fall, "fall")
  t:step "rise"
  local rise = t:record(signals, "1 s", function() t:command { thrust = "3.2 N" } end)
  t:expect(rise:rise_time "thrust", "thrust rise 2.0 to 3.2 N"):at_most "50 ms"
  t:expect(rise:response_time "thrust", "command on the wire to 90 %"):at_most "70 ms"
  t:expect(rise:overshoot "thrust", "overshoot"):at_most "10 %"
  t:expect(rise:settled("thrust", "2 %"), "settled within 2 %"):at_most "150 ms"
  safe(t, rise, "rise")
end

local function large_step(t, inertia)
  t:step "large step"
  t:command { thrust = "0.8 N" }
  t:wait "2 s"
  local low = point(t)
  local rise = t:record(signals, "1 s", function() t:command { thrust = "4 N" } end)
  t:expect(rise:final "thrust", "thrust after the step"):within("3.6 N", "4.4 N")
  local bound = bound_s(low, point(t), inertia)
  t:log(string.format("20 A alone take %.1f ms", 1e3 * bound))
  t:expect(rise:rise_time "thrust", "thrust rise 0.8 to 4.0 N, with 10 % over what 20 A alone take")
      :at_most(string.format("%.2f ms", 1.1e3 * bound))
  safe(t, rise, "large rise")
end

local function steps(name, supply, missing, more)
  local inertia = inertia_kgm2 * (1 + (more or 0))
  plan("thrust_steps_" .. name) {
    image = "esc", board = "esc32v2",
    stand = {
      prop = "hk_10x4.5", supply = supply,
      motor = {
        inertia = string.format("%.5e kg m2", inertia), kv_rpm_per_V = kv_rpm_per_V,
        no_load_current = no_load_A .. " A",
      },
    },
    tags = { "esc" },
    timeout = "20 s",
    run = function(t)
      t:wait "200 ms"
      calibrate(t)
      start(t, "3.2 N")
      if missing then t:fault { kind = "supply_dip", value = missing } end
      t:wait "1 s"
      small_steps(t)
      large_step(t, inertia)
      t:expect(t:value "armed", "still armed"):equal(1)
      t:expect(t:value "shoot_through", "legs shorted"):equal(0)
    end,
  }
end

steps("16v8", "16.8 V")
steps("15v7", "15.7 V") -- armed at its very limit
steps("14v0", "15.7 V", "1.7 V")
steps("heavy", "16.8 V", nil, 0.12)
steps("heavy_14v0", "15.7 V", "1.7 V", 0.12)
steps("light", "16.8 V", nil, -0.12)

plan "arming_voltage_too_low" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", supply = "15.69 V" },
  tags = { "quick", "esc" },
  timeout = "20 s",
  run = function(t)
    t:wait "1 s"
    t:expect(t:value "armed", "armed at 15.69 V"):equal(0)
    t:within("10 ms", function(s) return flag(s.esc_flags, 4) end, "told as under-voltage")
    local off = t:record({ "winding_peak" }, "1 s", function() t:command { thrust = "2 N" } end)
    t:expect(off:max "winding_peak", "winding current"):at_most "0.1 A"
  end,
}
