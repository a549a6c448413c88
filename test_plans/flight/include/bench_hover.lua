-- A hover of 5 s with what a bench of a flight controller has: this host is the vehicle, the radio is a line.
include "include/hover.lua"
include "include/judged_hover.lua"

-- before(t): once it says what it does.
function bench_hover(name, board, tags, before)
  plan(name) {
    image = "flight", board = board, vehicle = "hp_quad",
    tags = tags, timeout = "40 s",
    run = function(t)
      t:step "boot"
      t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
      if before then before(t) end
      t:within("8 s", function(s) return s.told_ready == 1 end, "it says that it can be armed")
      t:step "take-off"
      take_off(t)
      t:step "hover"
      judged_stay(t, "5 s", "")
      t:step "land"
      t:command { land = true }
      t:within("10 s", function(s) return s.on_ground == 1 end, "on the ground")
      t:within("5 s", function(s) return s.told_armed == 0 end, "disarmed")
    end,
  }
end
