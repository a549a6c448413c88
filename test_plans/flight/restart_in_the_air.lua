-- All four motors stopped in the air, the propellers braked by their motors' friction or turned backward by the air,
-- and started again there: by force (`force`: 21196 in MAV_CMD_COMPONENT_ARM_DISARM), under the rules of
-- firmware/flight/restart.hpp. What it refuses, it tells: one motor of four lost is a fail-safe, no restart.
-- Stopped from level flight. A copy's rotors differ, and so does how they run down: in 0.4 s their unequal thrust turns
-- seed 1's body by 0.9 rad/s about its diagonal, where the drawing's leaves it level. Nothing can stop that with the motors off: it
-- lies on its side after 1.4 s, at 155 degrees after 2.4, and the air that meets its rotors from above turns them
-- forward. So what a long fall does to the propellers from below is flown by the drawing; on copies, that the image turns it
-- upright and brakes, for as long as what that takes fits above the ground: by firmware/flight/restart.hpp
-- 60 m are enough for seed 1's until 1.9 s after its rotors were stopped.
include "include/gps.lua"
include "include/hover.lua"
include "include/parameter.lua"

-- From the ground to a hover 60 m above it, outdoors.
local function to_60_m(t)
  t:step "up to 60 m"
  t:within("90 s", function(s) return s.receiver_north_m == s.receiver_north_m end, "the origin of its frame is told")
  set_parameter(t, "FENCE_HEIGHT", 90)
  t:wait "4 s"
  t:command { arm = true }
  t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
  t:command { takeoff = "6 m" }
  t:within("30 s", function(s) return s.told_height_m > 5.8 end, "6 m high")
  t:command { attitude = { roll = "0 deg", pitch = "0 deg" }, thrust = "60 %" } -- set-points of place climb at 0.5 m/s
  t:within("40 s", function(s) return s.height_m > 52 end, "52 m high")
  t:command { position = { height = "60 m" } }
  t:within("30 s", function(s) return s.height_m > 58.5 and math.abs(s.climb_mps) < 0.7 end, "60 m high")
  t:wait "2 s"
  t:command { attitude = { roll = "0 deg", pitch = "0 deg" }, thrust = "50 %" }
  t:wait "1.5 s"
end

-- No rotor is driven: at most the current that their status is told with.
local function falls(t, duration)
  local currents = { "winding_current_1", "winding_current_2", "winding_current_3", "winding_current_4" }
  t:wait "300 ms" -- the radio, a set-point, the winding's last current
  -- A command that the radio lost comes again each 300 ms: two may be lost.
  t:within("600 ms", function(s)
    return math.max(s.winding_current_1_A, s.winding_current_2_A, s.winding_current_3_A, s.winding_current_4_A) < 0.5
  end, "falling: no rotor is driven any more")
  local fall = t:record(currents, duration)
  for _, current in ipairs(currents) do t:expect(fall:max(current), "falling: " .. current):at_most "0.5 A" end
end

-- Asked once: the ground station repeats a command until it is answered, whatever the answer.
local function restarts(t, most_tilt) -- of false: from any
  t:step "restart"
  local began = t:value("height", "m")
  local lowest, tilt = t:always("height"), most_tilt and t:always("tilt")
  lowest:at_least "10 m"
  if tilt then tilt:at_most(most_tilt) end
  t:command { arm = true, force = true }
  -- Beside the command's way: 0.35 s until the rotors carry, and from 16 m/s at 12 m/s2 1.4 s.
  t:within("4 s", function(s) return s.climb_mps > -0.5 and s.speed_1_radps > 300 end, "the fall is over")
  t:log(string.format("from %.1f m, over at %.1f m", began, t:value("height", "m")))
  t:told("3 s", "restarted in the air")
  t:command { position = { height = string.format("%.1f m", t:value("height", "m")) } }
  t:within("3 s", function(s) return s.told_state == 2 end, "told as flying")
  t:wait "4 s"
  t:step "hover, judged"
  local hover = t:record({ "height", "climb", "tilt", "receiver_north", "receiver_east" }, "5 s")
  t:expect(hover:max "climb", "hover: climb"):at_most "0.6 m/s"
  t:expect(hover:min "climb", "hover: sinking"):at_least "-0.6 m/s"
  t:expect(hover:max "tilt", "hover: tilt"):at_most "25 deg"
  t:expect(hover:min "height", "hover regained above"):at_least "10 m"
  lowest:stop()
  if tilt then tilt:stop() end
end

local function plan_at_60_m(name, more, run)
  plan(name) {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad", vehicle_with = more.vehicle_with,
    tags = { "flight", "nightly" }, timeout = "400 s",
    outdoors = true, fence = { radius = "40 m", height = "90 m" },
    run = function(t)
      to_60_m(t)
      run(t)
    end,
  }
end

plan_at_60_m("restart: stopped by command", {}, function(t)
  t:step "stopped"
  t:command { arm = false, force = true }
  falls(t, t:drawn("0.5 s", "1.2 s"))
  t:told("1 s", "motors stopped by command")
  t:command { arm = true }
  t:within("1 s", function(s) return s.command_result == 1 end, "arming without force is refused")
  t:told("1 s", "motors stopped in the air")
  restarts(t, "130 deg")
end)

plan_at_60_m("restart: after a long fall", {}, function(t)
  t:step "stopped"
  t:command { arm = false, force = true }
  falls(t, t:drawn("1.2 s", "1.4 s"))
  restarts(t, false)
end)

-- Motors of little friction: the rising air turns the propellers backward. All four of them only on the drawing: copies tilt
-- as they fall, and of three copies (seeds 1 to 3) two had a propeller that turned forward or not fast enough backward.
local of_little_friction = { ["motor.no_load_current"] = "0.3 A", tolerance = "none" }
plan_at_60_m("restart: windmilling backward", { vehicle_with = of_little_friction }, function(t)
  t:step "stopped"
  t:command { arm = false, force = true }
  falls(t, "1.5 s")
  t:within("800 ms", function(s)
    return math.max(s.speed_1_radps, s.speed_2_radps, s.speed_3_radps, s.speed_4_radps) < -10
  end, "all four turn backward")
  restarts(t, "60 deg")
end)

-- What copies make of it is ended as well, from whatever tilt it has led to.
local copy_of_little_friction = { ["motor.no_load_current"] = "0.3 A" }
plan_at_60_m("restart: copies that windmill", { vehicle_with = copy_of_little_friction }, function(t)
  t:step "stopped"
  t:command { arm = false, force = true }
  falls(t, t:drawn("1.7 s", "1.9 s"))
  restarts(t, false)
end)

-- The pack's voltage breaks in: all four ESCs stop and disarm.
plan_at_60_m("restart: all ESCs browned out", {}, function(t)
  t:step "stopped"
  t:fault { kind = "supply_dip", value = "9 V", duration = "100 ms" }
  t:told("2 s", "a motor has stopped")
  falls(t, "0.7 s") -- an ESC arms again by 25 zeros, half a second
  restarts(t, "130 deg")
end)

-- What is refused, and told; the rotors stay off and it comes down as it does.
local function refused(name, words, stop)
  plan("restart refused: " .. name) {
    image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
    tags = { "flight", "fail_safe" }, timeout = "60 s",
    run = function(t)
      hover(t)
      stop(t)
      local off = t:always("no rotor is driven", function(s)
        for motor = 1, 4 do
          if s["winding_current_" .. motor .. "_A"] > 0.5 then return false end
        end
        return true
      end)
      t:command { arm = true, force = true }
      t:within("400 ms", function(s) return s.command_result == 1 end, "refused for the time being")
      t:told("1.5 s", words)
      t:within("3 s", function(s) return s.told_armed == 0 and s.on_ground == 1 end, "on the ground, disarmed")
      off:stop()
    end,
  }
end

local function all_off(t)
  t:within("300 ms", function(s)
    for motor = 1, 4 do
      if s["winding_current_" .. motor .. "_A"] > 0.1 then return false end
    end
    return true
  end, "no rotor is driven")
end

refused("too low", "too low to restart", function(t)
  t:command { arm = false, force = true }
  all_off(t)
end)

-- Its ESC is well again by the time of the question, and all four say that they are armed.
refused("one motor lost", "a motor has stopped", function(t)
  t:fault { kind = "esc_stopped", motor = 2, duration = "80 ms" }
  all_off(t)
end)

refused("attitude lost", "attitude unknown", function(t)
  t:fault { kind = "sensor_frozen", device = "imu", duration = "80 ms" }
  all_off(t)
end)
