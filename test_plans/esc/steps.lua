-- Steps of thrust on a full, a used and a nearly empty pack, and with more and less inertia. What a supply lacks
-- below 15.7 V is taken from it once the rotor turns. How long 20 A alone would take of this very copy from 0.8 to
-- 4.0 N the harness computes (t:shortest_rise): from its inertia, Kt and friction, and the air with the inflow's lag.
-- The power-based controller: rise_by_power.lua; open loop: open_loop.lua.
-- The ESC is calibrated: until then it leaves a tenth of its current.
include "include/start.lua"
include "include/calibration.lua"

local signals = { "thrust", "winding_peak", "bus_peak" }

local function small_steps(t)
  t:step "fall"
  local fall = t:record(signals, "1 s", function() t:command { thrust = "2 N" } end)
  ends(t, fall, 2, "fall")
  t:expect(fall:fall_time "thrust", "thrust fall 3.2 to 2.0 N"):at_most "70 ms"
  safe(t, fall, "fall")
  t:step "rise"
  local rise = t:record(signals, "1 s", function() t:command { thrust = "3.2 N" } end)
  t:expect(rise:rise_time "thrust", "thrust rise 2.0 to 3.2 N"):at_most "50 ms"
  t:expect(rise:response_time "thrust", "command on the wire to 90 %"):at_most "70 ms"
  t:expect(rise:overshoot "thrust", "overshoot"):at_most "10 %"
  ends(t, rise, 3.2, "rise")
  t:expect(rise:settled("thrust", "2 %"), "rise settled within 2 %"):at_most "150 ms"
  safe(t, rise, "rise")
end

local function large_step(t)
  t:step "large step"
  t:command { thrust = "0.8 N" }
  t:wait "2 s"
  local low_N = t:value("thrust", "N")
  local rise = t:record(signals, "1 s", function() t:command { thrust = "4 N" } end)
  ends(t, rise, 4, "large rise")
  local bound = t:shortest_rise { from = low_N .. " N", to = rise:final("thrust").value .. " N", current = "20 A" }
  t:log(string.format("20 A alone take %.1f ms", 1e3 * bound.value))
  t:expect(rise:rise_time "thrust", "thrust rise 0.8 to 4.0 N, with 10 % over what 20 A alone take")
      :at_most(string.format("%.2f ms", 1.1e3 * bound.value))
  safe(t, rise, "large rise")
end

-- sensed_V: at which it arms; left_V: of the supply once it turns; more: inertia.
local function steps(name, sensed_V, left_V, more)
  plan("thrust_steps_" .. name) {
    image = "esc", board = "esc32v2",
    stand = {
      prop = "hk_10x4.5", supply = "16.8 V", motor = { inertia = more or "0 %" },
    },
    tags = { "esc" },
    timeout = "20 s",
    run = function(t)
      t:wait "100 ms"
      if sensed_V then sensed_at(t, sensed_V) end
      t:wait "100 ms"
      calibrate(t)
      start(t, "3.2 N")
      if left_V then t:fault { kind = "supply_dip", value = t:value("bus_voltage", "V") - left_V .. " V" } end
      t:wait "1 s"
      small_steps(t)
      large_step(t)
      t:expect(t:value "armed", "still armed"):equal(1)
      t:expect(t:value "shoot_through", "legs shorted"):equal(0)
    end,
  }
end

-- An ESC arms at 15.7 V as it senses them; noise and steps of its converter are 9 and 6 mV of the bus.
steps("16v8")
steps("15v7", 15.75)
steps("14v0", 15.75, 14)
steps("heavy", nil, nil, "+12 %")
steps("heavy_14v0", 15.75, 14, "+12 %")
steps("light", nil, nil, "-12 %")

plan "arming_voltage_too_low" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", supply = "16.8 V" },
  tags = { "quick", "esc" },
  timeout = "20 s",
  run = function(t)
    t:wait "50 ms"
    sensed_at(t, 15.65)
    t:wait "1 s"
    t:expect(t:value "armed", "armed at 15.65 V as it senses them"):equal(0)
    t:within("10 ms", function(s) return flag(s.esc_flags, 4) end, "told as under-voltage")
    local off = t:record({ "winding_peak" }, "1 s", function() t:command { thrust = "2 N" } end)
    t:expect(off:max "winding_peak", "winding current"):at_most "0.1 A"
  end,
}
