-- The set-points' wire spoiled for a while or for ever: nothing wrong is obeyed, rejected writes are told.
-- Lines stuck low for a while: the slave answers again when they are free. Wrong bytes: i2c_raw.lua.
include "include/start.lua"

local function wire_plan(name, run)
  plan(name) {
    image = "esc", board = "esc32v2",
    stand = { prop = "hk_10x4.5", battery = "4s_2200" },
    tags = { "esc", "faults" },
    timeout = "20 s",
    run = run,
  }
end

local function flies_on(t, words, fault)
  start(t, "2 N")
  t:step(words)
  local record = t:record({ "thrust" }, "1 s", function() t:fault(fault) end)
  t:expect(record:max "thrust", "highest thrust, " .. words):at_most "2.3 N"
  t:expect(record:min "thrust", "lowest thrust, " .. words):at_least "1.8 N"
  t:expect(t:value "armed", "still armed"):equal(1)
end

local function goes_off(t, words, fault)
  start(t, "2 N")
  t:step(words)
  t:fault(fault)
  t:wait "600 ms"
  local off = t:record({ "winding_peak" }, "500 ms")
  t:expect(off:max "winding_peak", "winding current from 0.6 s on, " .. words):at_most "0.1 A"
end

wire_plan("i2c_nack_short", function(t)
  flies_on(t, "refused for 300 ms", { kind = "i2c_nack", bus = "i2c2", duration = "300 ms" })
end)

wire_plan("i2c_nack_lasting", function(t)
  goes_off(t, "refused for ever", { kind = "i2c_nack", bus = "i2c2" })
end)

wire_plan("i2c_silence_lasting", function(t)
  goes_off(t, "nothing heard", { kind = "i2c_silence", bus = "i2c2" })
end)

-- Bit 4 of the first byte flipped: 2 N would be another thrust. Each burst holds one write; a status read is
-- spoiled too when it falls into one, so the bursts come at different phases of the reads' 50 ms.
wire_plan("i2c_flipped_bits_short", function(t)
  start(t, "2 N")
  t:within("10 ms", function(s) return not flag(s.esc_flags, 7) end, "no write rejected before")
  t:step "flipped"
  for _, after in ipairs { "0 ms", "70 ms", "140 ms", "210 ms", "280 ms" } do
    t:fault { kind = "i2c_flip_bit", bus = "i2c2", start = after, duration = "20 ms", value = 4 }
  end
  t:within("300 ms", function(s) return flag(s.esc_flags, 7) end, "told of rejected writes")
  local record = t:record({ "thrust" }, "400 ms")
  t:expect(record:max "thrust", "highest thrust, flipped"):at_most "2.3 N"
  t:expect(record:min "thrust", "lowest thrust, flipped"):at_least "1.8 N"
  t:within("10 ms", function(s) return not flag(s.esc_flags, 7) end, "none any more once the wire is sound")
  t:expect(t:value "armed", "still armed"):equal(1)
end)

wire_plan("i2c_flipped_bits_lasting", function(t)
  goes_off(t, "every set-point flipped", { kind = "i2c_flip_bit", bus = "i2c2", value = 4 })
end)

-- Until the next whole 100 ms: a write begins there, and a read half a millisecond later.
local function align(t)
  local past = math.floor(t:now().value * 1000 + 0.5) % 100
  if past > 0 then t:wait((100 - past) .. " ms") end
end

-- The line goes low in the middle of a write, of a read, or between.
local function recovers(name, kind, duration)
  wire_plan(name, function(t)
    start(t, "2 N")
    for _, when in ipairs { { "in a write", "100050 us" }, { "in a read", "100600 us" }, { "between", "105 ms" } } do
      align(t)
      t:step("stuck " .. when[1])
      local record = t:record({ "thrust" }, "500 ms", function()
        t:fault { kind = kind, bus = "i2c2", start = when[2], duration = duration }
      end)
      t:expect(record:max "thrust", "highest thrust, stuck " .. when[1]):at_most "2.3 N"
      t:expect(record:min "thrust", "lowest thrust, stuck " .. when[1]):at_least "1.8 N"
      local refused = t:value("i2c_refused").value
      t:wait "500 ms"
      t:expect(t:value("i2c_refused").value - refused, "orders refused once the line is free"):equal(0)
      t:expect(t:value "armed", "still armed"):equal(1)
    end
    t:command { thrust = "3 N" }
    t:within("150 ms", function(s) return s.thrust_N > 2.9 end, "set-points are heard again")
  end)
end
recovers("i2c_stuck_sda_short", "i2c_stuck_sda", "300 ms")
recovers("i2c_stuck_scl_short", "i2c_stuck_scl", "300 ms")
recovers("i2c_stuck_scl_blink", "i2c_stuck_scl", "2 ms")

wire_plan("i2c_stuck_sda_lasting", function(t)
  goes_off(t, "data stuck for ever", { kind = "i2c_stuck_sda", bus = "i2c2" })
end)

wire_plan("i2c_stuck_scl_lasting", function(t)
  goes_off(t, "clock stuck for ever", { kind = "i2c_stuck_scl", bus = "i2c2" })
end)

-- Off while the line is stuck; when it is free the zeros arm again.
wire_plan("i2c_stuck_scl_long", function(t)
  goes_off(t, "clock stuck for 1.5 s", { kind = "i2c_stuck_scl", bus = "i2c2", duration = "1500 ms" })
  t:wait "1 s"
  t:expect(t:value "armed", "disarmed"):equal(0)
  t:command { stop = true }
  t:within("2 s", function(s) return s.armed == 1 end, "armed again")
  t:command { thrust = "2 N" }
  t:within("3 s", function(s) return s.thrust_N > 1.9 end, "turns again")
end)
