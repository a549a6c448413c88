-- What a careless master may write and read: wrong lengths, CRCs, upper bits. Nothing of it is obeyed, all of
-- it is told; a read of any length begins with the status.
include "include/start.lua"

-- CRC-8/SMBUS over the address byte and what follows, bit by bit.
local function crc(bytes)
  local rest = 0
  for _, byte in ipairs(bytes) do
    rest = rest ~ byte
    for _ = 1, 8 do
      rest = rest & 0x80 ~= 0 and rest << 1 & 0xFF ~ 0x07 or rest << 1
    end
  end
  return rest
end
local function hex(bytes)
  local words = {}
  for i, byte in ipairs(bytes) do words[i] = string.format("%02X", byte) end
  return table.concat(words, " ")
end
local kWrite = 0x29 << 1
local high, low = 0xFF, 0x07 -- full thrust

local function raw_plan(name, run)
  plan(name) {
    image = "esc", board = "esc32v2",
    stand = { prop = "hk_10x4.5", battery = "4s_2200" },
    tags = { "esc", "faults" },
    timeout = "30 s",
    run = run,
  }
end

-- Sends it 20 times between good writes; told within the next read.
local function never_obeyed(t, words, bytes)
  t:step(words)
  t:within("60 ms", function(s) return not flag(s.esc_flags, 7) end, "nothing rejected before " .. words)
  local record = t:record({ "thrust", "speed" }, "400 ms", function()
    t:command { i2c_raw = { bytes = hex(bytes), times = 20, every = "20 ms" } }
  end)
  t:expect(record:max "thrust", "highest thrust, " .. words):at_most "2.1 N"
  t:expect(record:min "thrust", "lowest thrust, " .. words):at_least "1.9 N"
  t:within("60 ms", function(s) return flag(s.esc_flags, 7) end, words .. ": told")
  t:wait "100 ms"
end

raw_plan("i2c_wrong_writes", function(t)
  start(t, "2 N")
  local good = crc { kWrite, high, low }
  never_obeyed(t, "one byte", { high })
  never_obeyed(t, "two bytes, the second a CRC over the first", { high, crc { kWrite, high } })
  never_obeyed(t, "four bytes, a good write with one more", { high, low, good, 0x00 })
  never_obeyed(t, "four bytes, the last a CRC over three", { high, low, good, crc { kWrite, high, low, good } })
  never_obeyed(t, "forty bytes", { table.unpack((function()
    local long = {}
    for i = 1, 40 do long[i] = 0xFF end
    return long
  end)()) })
  never_obeyed(t, "a CRC without the address", { high, low, crc { high, low } })
  never_obeyed(t, "a CRC of another address", { high, low, crc { 0x2A << 1, high, low } })
  never_obeyed(t, "a CRC off by one bit", { high, low, good ~ 0x10 })
  never_obeyed(t, "upper bits set under a good CRC", { high, 0x0F, crc { kWrite, high, 0x0F } })
  t:expect(t:value "armed", "still armed"):equal(1)
  t:step "the same bytes made good are obeyed: the wire does carry them"
  t:command { silence = true }
  t:command { i2c_raw = { bytes = hex { high, low, good }, times = 10, every = "20 ms" } }
  t:within("200 ms", function(s) return s.thrust_N > 2.5 end, "thrust rises")
end)

raw_plan("i2c_wrong_writes_only", function(t)
  start(t, "2 N")
  t:step "only wrong writes"
  t:command { silence = true }
  t:command { i2c_raw = { bytes = hex { high, low, 0x00 }, times = 60, every = "20 ms" } }
  t:wait "580 ms" -- the last good write was up to 20 ms before
  local off = t:record({ "winding_peak" }, "600 ms")
  t:expect(off:max "winding_peak", "winding current from 0.58 s on"):at_most "0.1 A"
  t:expect(t:value "armed", "disarmed"):equal(0)
end)

raw_plan("i2c_reads_of_all_lengths", function(t)
  start(t, "2 N")
  for _, length in ipairs { 1, 2, 5, 6, 7, 12, 40 } do
    t:step(length .. " bytes")
    t:command { i2c_raw = { read = length, times = 5, every = "20 ms" } }
    t:wait "120 ms"
    t:expect(t:value "i2c_raw_bytes", "bytes read"):equal(length)
    if length >= 6 then t:expect(t:value "i2c_raw_good", "status first, then FF, " .. length .. " bytes"):equal(1) end
  end
  t:step "write and read in one"
  t:command { i2c_raw = { bytes = "01 02", read = 6, times = 5, every = "20 ms" } }
  t:wait "120 ms"
  t:expect(t:value "i2c_raw_good", "status behind a repeated START"):equal(1)
  t:within("60 ms", function(s) return not flag(s.esc_flags, 7) end, "its rejected write was told, and then no more")
  t:expect(t:value "i2c_refused", "good reads spoiled by them"):equal(0)
  t:expect(t:value "thrust", "holds its thrust"):within("1.9 N", "2.1 N")
end)
