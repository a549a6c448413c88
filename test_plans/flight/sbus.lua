-- Flown by hand with a receiver that speaks SBUS: the image finds it by itself. That its flags, its silence and its
-- nonsense lead where a lost sum signal does (manual.lua), and that single bad frames are flown through.
include "include/by_hand.lua"
include "include/moment.lua"

plan "sbus" {
  image = "flight", board = "px4fmu_v1_sbus", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "60 s",
  run = function(t)
    boot_by_hand(t)
    arm_by_hand(t)
    t:budget("fw::imu_task") { period = "1 ms", jitter = "20 us", margin = "10 %" }
    t:budget("fw::attitude_task") { execution = "300 us", response = "500 us", margin = "10 %" }
    t:budget("cpu") { busy = "60 %", margin = "10 %" }
    take_off_by_hand(t)
    local held = t:record({ "height", "north", "east" }, "2 s")
    t:expect(held:rms_error("height", string.format("%.3f m", t:value("height", "m"))), "it does not wander"):at_most "4 cm"
    t:command { rc = { mode = 1 } }
    t:wait "0.5 s"
    local roll = t:record("roll", "0.6 s", function() t:command { rc = { roll = "30 %" } } end)
    -- SBUS tells 100 % as 512 us beside the middle: 30 % is 154 us, (154 - 20) / 460 of 35 deg.
    t:expect(roll:final(), "roll as the stick asks"):within("8.7 deg", "11.7 deg")
    t:command { rc = { roll = "-30 %" } }
    t:wait "0.9 s"
    t:command { rc = { roll = "0 %", mode = 2 } }
    t:wait "2 s"
    t:command { rc = { thrust = "0 %" } }
    t:within("12 s", function(s) return s.on_ground == 1 end, "on the ground")
    t:within("6 s", function(s) return s.told_state == 1 end, "idling")
    t:command { rc = { arm = false } }
    t:within("3 s", function(s) return s.told_armed == 0 end, "disarmed by the switch")
  end,
}

for _, mode in ipairs { 1, 2 } do
  loss_by_hand("sbus", "px4fmu_v1_sbus", mode, "the receiver says failsafe",
    function(t) t:fault { kind = "rc_link_lost", device = "sbus" } end, "radio control lost")
end
loss_by_hand("sbus", "px4fmu_v1_sbus_lost", 1, "the receiver says no more than that frames are lost",
  function(t) t:command { rc = { on = false } } end, "radio control lost")
loss_by_hand("sbus", "px4fmu_v1_sbus", 2, "the receiver falls silent",
  function(t) t:fault { kind = "uart_silence", device = "sbus" } end, "radio control lost")
loss_by_hand("sbus", "px4fmu_v1_sbus", 1, "all that comes is nonsense",
  function(t) t:fault { kind = "rc_glitch", device = "sbus", value = "100 %" } end, "radio control gives nonsense")

plan "sbus, single bad frames are flown through" {
  image = "flight", board = "px4fmu_v1_sbus", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "60 s",
  run = function(t)
    boot_by_hand(t)
    arm_by_hand(t)
    take_off_by_hand(t)
    local bad = {
      { kind = "rc_glitch", device = "sbus", value = "10 %", duration = "4 s" },
      { kind = "uart_flip", device = "sbus", value = 0.005, duration = "4 s" },
      { kind = "uart_loss", device = "sbus", value = 0.005, duration = "4 s" },
    }
    for _, f in ipairs(bad) do
      t:fault(f)
      local held = t:record({ "height", "tilt" }, "4 s")
      t:expect(held:max "tilt", f.kind .. ": tilt"):at_most "8 deg"
      t:expect(held:min "height", f.kind .. ": height"):at_least "80 cm"
      t:expect(t:value "told_state", f.kind .. ": still flown by hand"):equal(2)
    end
  end,
}

-- Its lines idle the other way round: no frame is whole, and a switch that nobody reads arms nothing.
plan "sbus, without an inverter nothing is read" {
  image = "flight", board = "px4fmu_v1_sbus_bare", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "30 s",
  run = function(t)
    boot_by_hand(t)
    t:command { rc = { arm = true } }
    t:wait "2 s"
    t:expect(t:value "told_armed", "armed"):equal(0)
    t:expect(t:value "told_ready", "all else is ready"):equal(1)
  end,
}
