-- A person flies by velocity and heading (thesis, section 6.5.2, figures 6.9 and 6.10): a script of sticks, a reaction of
-- 250 ms, a hand that lags by 0.1 s. What the vehicle does must follow the script by no more than that, 100 ms for the
-- radio's next frame and the 2.2 s in which a turn of velocity settles (velocity.lua).
include "include/hover.lua"

plan "teleoperation" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "90 s",
  run = function(t)
    hover(t)
    t:step "by hand"
    local flown = t:record({ "velocity_north", "velocity_east", "height", "yaw", "north", "east" }, "3.9 s", function()
      t:command { teleoperation = { reaction = "250 ms", script = {
        { at = "0 s", north = "0.4 m/s", yaw_rate = "20 deg/s" },
        { at = "4 s", north = "-0.4 m/s", yaw_rate = "0 deg/s" },
        { at = "8 s", north = "0 m/s", east = "0.3 m/s", height = "1.5 m" },
        { at = "12 s", east = "0 m/s" },
      } } }
    end)
    t:expect(flown:final "velocity_north", "north by the first stick"):within("0.35 m/s", "0.45 m/s")
    t:expect(flown:settled("0.1 m/s", { velocity_north = "0.4 m/s" }), "first stick, settled"):within("0.3 s", "2.6 s")
    local still = t:record({ "velocity_north", "yaw" }, "4 s")
    t:expect(still:final "velocity_north", "back by the second"):within("-0.45 m/s", "-0.35 m/s")
    -- 4 s at 20 deg/s; reaction and lag shift begin and end alike. The heading's loop may swing over by a tenth.
    t:expect(still:final "yaw", "heading"):within("72 deg", "88 deg")
    local third = t:record({ "velocity_north", "velocity_east", "height" }, "4 s")
    t:expect(third:final "velocity_east", "east by the third"):within("0.25 m/s", "0.35 m/s")
    t:expect(third:final "velocity_north", "and no longer north"):within("-0.05 m/s", "0.05 m/s")
    t:expect(third:final "height", "height by the third"):within("1.45 m", "1.55 m")
    t:wait "3 s"
    t:expect(t:value "velocity_east", "stands at the end"):within("-0.05 m/s", "0.05 m/s")
    t:command { land = true }
    t:within("15 s", function(s) return s.told_armed == 0 end, "landed")
  end,
}
