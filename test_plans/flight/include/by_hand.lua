-- What the plans share that are flown by hand, whichever receiver brings the sticks; with include/moment.lua.
include "include/fail_safe.lua"

function boot_by_hand(t)
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  t:command { rc = { mode = 2 } }
  t:wait "4 s" -- gyro bias on the ground, capture poses, ESC arming zeros
end

function arm_by_hand(t)
  t:command { rc = { arm = true } }
  t:within("2 s", function(s) return s.told_armed == 1 end, "armed by the switch")
  t:wait "2 s" -- the rotors come to idle
end

function take_off_by_hand(t)
  t:command { rc = { thrust = "100 %" } }
  t:within("6 s", function(s) return s.height_m > 0.9 end, "0.9 m high")
  t:command { rc = { thrust = "50 %" } }
  t:wait "3 s"
end

-- Flown by hand in this mode it loses the sticks, and lands by itself; told is why.
function loss_by_hand(family, board, mode, name, lose, words)
  plan(family .. " " .. (mode == 1 and "attitude" or "velocity") .. ", " .. name) {
    image = "flight", board = board, vehicle = "hp_quad",
    tags = { "flight" }, timeout = "90 s",
    run = function(t)
      boot_by_hand(t)
      arm_by_hand(t)
      take_off_by_hand(t)
      t:command { rc = { mode = mode } }
      t:wait "0.5 s"
      some_moment(t)
      t:step "lost"
      lose(t)
      lands(t, words, 3, { noticed = "2.5 s", tilt = "25 deg", down = "15 s" })
      t:expect(t:value "height", "on its gear"):at_most "15 cm"
    end,
  }
end
