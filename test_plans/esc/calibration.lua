-- What `whirl calibrate esc` has found is typed into the image, saved to its flash, and still there after a
-- reset; the flag `uncalibrated` falls and mode 5 goes by the rotor's model.
-- Left out: power-down with loss of RAM (the watchdog's reset keeps it; start-up clears what is not in flash).
include "include/start.lua"
include "include/calibration.lua"

local kUncalibrated = 6

-- Every parameter as the image tells it.
local function told(t)
  local all = {}
  for _, line in ipairs(calibration) do
    local name = line:match "^set (%S+)"
    all[name] = t:ask("get " .. name, "^" .. name .. " ")
  end
  all.identified = t:ask("get identified", "^identified ")
  all.mode = t:ask("get mode", "^mode ")
  return all
end

plan "calibration_round_trip" {
  image = "esc", board = "esc32v2",
  stand = { prop = "hk_10x4.5", supply = "16.4 V", mode = "thrust_by_power" },
  tags = { "esc" },
  timeout = "140 s", may_reset = true,
  run = function(t)
    t:within("3 s", function(s) return s.armed == 1 end, "armed after its zeros")
    t:expect(flag(t:value("esc_flags").value, kUncalibrated) and 1 or 0, "a new ESC says that it is not calibrated"):equal(1)
    local factory = told(t)
    calibrate(t)
    t:ask("mode 5", "^ok$")
    local set = told(t)
    t:expect(factory.c0 == set.c0 and 1 or 0, "the factory's constants are still there"):equal(0)
    t:ask("save", "^ok$")
    t:step "reset"
    t:fault { kind = "code_hangs", ["function"] = "fw::esc::control_task", duration = "300 ms" }
    t:within("400 ms", function(s) return s.resets >= 1 end, "reset by its watchdog")
    t:wait "1 s"
    local kept = told(t)
    for name, line in pairs(set) do
      t:expect(kept[name] == line and 1 or 0, "kept: " .. name):equal(1)
    end
    t:within("3 s", function(s) return s.armed == 1 end, "armed anew")
    t:expect(flag(t:value("esc_flags").value, kUncalibrated) and 1 or 0, "its current sense is not warm"):equal(1)
    t:wait "100 s"
    t:expect(flag(t:value("esc_flags").value, kUncalibrated) and 1 or 0, "it says that it is calibrated"):equal(0)
    t:step "mode 5 in wind"
    t:command { thrust = "3.2 N" }
    t:within("3 s", function(s) return s.speed_radps > 150 end, "turning")
    t:ask("stream 100", "^ok$")
    t:gust { down = "4 m/s" }
    t:wait "3 s"
    local wind = t:record({ "thrust", "esc_thrust", "esc_observable" }, "1 s")
    t:expect(wind:mean "esc_observable", "share of the time that power tells the inflow"):at_least(0.99)
    t:expect(wind:mean "thrust", "thrust held in 4 m/s"):within("3.0 N", "3.4 N")
  end,
}
