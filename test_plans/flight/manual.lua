-- Flown by hand: armed by the switch, taken off by throttle in manual velocity, held by sticks in manual
-- attitude, given to the autopilot to land. Then what must not happen: arming with the throttle up, and
-- flying on when the transmitter is gone; and that a receiver's nonsense, frame by frame, moves nothing.
include "include/by_hand.lua"
include "include/moment.lua"

plan "manual" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "quick", "flight" }, timeout = "90 s",
  run = function(t)
    boot_by_hand(t)
    t:step "arming is refused with the throttle up"
    t:command { rc = { thrust = "30 %" } }
    t:wait "0.3 s"
    t:command { rc = { arm = true } }
    t:wait "2 s"
    t:expect(t:value "told_armed", "armed with the throttle up"):equal(0)
    t:command { rc = { thrust = "0 %" } }
    t:wait "2 s"
    t:expect(t:value "told_armed", "armed by lowering the throttle"):equal(0)
    t:command { rc = { arm = false } }
    t:wait "0.5 s"
    arm_by_hand(t)

    t:step "manual velocity"
    take_off_by_hand(t)
    local held = t:record({ "height", "north", "east" }, "2 s")
    t:expect(held:max "height", "height holds"):at_most "1.5 m"
    t:expect(held:rms_error("height", string.format("%.3f m", t:value("height", "m"))), "and does not wander"):at_most "4 cm"
    local ahead = t:record({ "velocity_north", "velocity_east" }, "1.5 s", function()
      t:command { rc = { pitch = "-50 %" } }
    end)
    t:expect(ahead:final "velocity_north", "stick forward: velocity ahead"):within("0.45 m/s", "0.75 m/s")
    t:expect(ahead:final "velocity_east", "and none sideways"):within("-0.1 m/s", "0.1 m/s")
    t:command { rc = { pitch = "0 %" } }
    t:wait "2.5 s"
    t:command { rc = { pitch = "50 %" } }
    t:wait "1.5 s"
    t:command { rc = { pitch = "0 %" } }
    t:wait "2.5 s"

    t:step "manual attitude"
    t:command { rc = { mode = 1 } }
    t:wait "0.5 s"
    local roll = t:record({ "roll", "pitch" }, "0.6 s", function() t:command { rc = { roll = "30 %" } } end)
    -- 30 % of travel beyond the dead zone of 20 us: (150 - 20) / 460 of 35 deg.
    t:expect(roll:final "roll", "roll as the stick asks"):within("8.4 deg", "11.4 deg")
    t:command { rc = { roll = "-30 %" } }
    t:wait "0.9 s"
    t:command { rc = { roll = "0 %" } }
    local yaw = t:record("yaw", "1.5 s", function() t:command { rc = { yaw = "20 %" } } end)
    -- 80 / 460 of 120 deg/s, for 1.5 s less a start of some 0.3 s
    t:expect(yaw:max() , "it turns right"):within("20 deg", "35 deg")
    t:command { rc = { yaw = "0 %" } }
    t:wait "0.5 s"

    t:step "autonomous"
    t:command { rc = { mode = 3 } }
    t:wait "4 s"
    local hold = t:record({ "height", "tilt", "velocity_north", "velocity_east" }, "2 s")
    t:expect(hold:rms_error { velocity_north = "0 m/s", velocity_east = "0 m/s" }, "it stays where it was left"):at_most "0.1 m/s"
    t:expect(hold:max "tilt", "and level"):at_most "5 deg"
    t:command { land = true }
    t:within("12 s", function(s) return s.on_ground == 1 end, "on the ground")
    t:within("6 s", function(s) return s.told_armed == 0 end, "disarmed")
  end,
}

plan "manual landing" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "90 s",
  run = function(t)
    boot_by_hand(t)
    arm_by_hand(t)
    take_off_by_hand(t)
    t:step "down by throttle"
    t:command { rc = { thrust = "0 %" } }
    t:within("12 s", function(s) return s.on_ground == 1 end, "on the ground")
    t:within("6 s", function(s) return s.told_state == 1 end, "idling")
    t:wait "3 s"
    t:expect(t:value "told_armed", "armed until the switch says so"):equal(1)
    t:command { rc = { thrust = "30 %", arm = false } }
    t:wait "2 s"
    t:expect(t:value "told_armed", "the switch with the throttle up"):equal(1)
    t:command { rc = { thrust = "0 %" } }
    t:within("3 s", function(s) return s.told_armed == 0 end, "disarmed by the switch")
  end,
}

for _, mode in ipairs { 1, 2 } do
  loss_by_hand("manual", "px4fmu_v1", mode, "the transmitter is switched off", function(t) t:command { rc = { on = false } } end,
    "radio control lost")
  loss_by_hand("manual", "px4fmu_v1", mode, "the receiver loses its transmitter",
    function(t) t:fault { kind = "rc_link_lost", device = "rc" } end, "radio control lost")
end

plan "manual, one frame in ten is nonsense" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "90 s",
  run = function(t)
    boot_by_hand(t)
    arm_by_hand(t)
    take_off_by_hand(t)
    t:fault { kind = "rc_glitch", device = "rc", value = "10 %" }
    local held = t:record({ "height", "tilt" }, "5 s")
    t:expect(held:max "tilt", "tilt"):at_most "8 deg"
    t:expect(held:min "height", "height"):at_least "80 cm"
    t:expect(t:value "told_state", "still flown by hand"):equal(2)
  end,
}
