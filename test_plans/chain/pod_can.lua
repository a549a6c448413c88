-- The flights of pod.lua with the pod's host on CAN, and what goes wrong on that bus.
include "include/flights.lua"
include "include/pod.lua"

local bus, board = "pod/can2", "pod_with_parts_can"

-- An answer on SPI waits for what the core is in: a load from CAN's registers behind a store to them, 131 ns (each 2 PCLK1 and one
-- HCLK on the bridge, and an edge of PCLK1), a line of flash, 30, then the entry, 71. Where another exception was requested in the same
-- access, the emulator enters that one first, 101 more; a core would not (late arrival). That is 333 ns, and 181 of
-- the handler: 248 of 762 are left at the least. Load: 40 % are the samples, three frames each, 12 % the rest.
pod_plan("pod hover on CAN", function(t)
  pod_hover(t, { answer_ns = 248, latency = "0.34 us", windows = function()
    t:can { bus = bus, load = "60 %", during = "10 s" }
    t:can { bus = bus, from = "host", during = "10 s" }
  end })
  t:expect(figure(t, "pod_untold"), "samples of which no status told whether they came in time"):equal(0)
end, board)

-- In the place of the ESCs, 7 %: SBUS 4 %, GPS 4 %.
pod_receivers("pod receivers on CAN", "pod_with_receivers_can", function(t) t:can { bus = bus, load = "60 %", during = "10 s" } end)

-- A status has just come: the next one's frames are 25 ms away.
local function after_a_status(t)
  local was, tries = figure(t, "pod_now_us"), 0
  while figure(t, "pod_now_us") == was and tries < 30 do tries = tries + 1 end
end

-- `limits`: of samples lost and late, from and to each. Every one of them is marked in the pod's status, and the flight goes on
-- within what it holds without.
local function flown_through(name, fault, limits, look)
  pod_plan("pod on CAN: " .. name, function(t)
    hovers(t)
    t:wait(t:drawn("0 s", "2 s"))
    local before = {}
    for _, count in ipairs { "lost", "late", "flagged", "untold" } do before[count] = figure(t, "pod_" .. count) end
    after_a_status(t)
    local struck = t:record({ "height", "offset", "tilt" }, "1 s", function()
      t:fault(fault)
      if look then look(t) end
    end)
    t:expect(struck:max "tilt", "meanwhile: tilt"):at_most "10 deg"
    t:expect(struck:max "height", "meanwhile: highest"):at_most "1.2 m"
    t:expect(struck:min "height", "meanwhile: lowest"):at_least "1.0 m"
    t:expect(struck:max "offset", "meanwhile: sideways"):at_most "20 cm"
    local now = {}
    for count, was in pairs(before) do now[count] = figure(t, "pod_" .. count) - was end
    t:expect(now.lost, "samples lost"):within(limits.lost[1], limits.lost[2])
    t:expect(now.late, "samples late"):within(limits.late[1], limits.late[2])
    t:expect(now.lost + now.late, "samples lost or late"):at_least(limits.some or 0)
    t:expect(now.flagged - now.lost - now.late, "marked in a status, but those"):equal(0)
    t:expect(now.untold, "samples of which no status told"):equal(0)
    local after = t:record({ "height", "offset" }, "3 s")
    t:expect(after:rms_error("height", "1.1 m"), "after: height RMS error"):at_most "5 cm"
    t:expect(after:rms_error("offset", "0 m"), "after: sideways RMS error"):at_most "10 cm"
    t:expect(figure(t, "pod_lost") - before.lost - now.lost, "samples lost, after"):equal(0)
    t:expect(t:value "told_armed", "flies on"):equal(1)
  end, board)
end

-- Five samples begin in that time, and one may be cut at its end or its start.
flown_through("frames that nobody receives for 5 ms", { kind = "can_lost", bus = bus, duration = "5 ms" },
              { lost = { 4, 7 }, late = { 0, 1 } })
-- Two or three of its frames go out meanwhile. What has gathered, 5 ms of half the bus, has the other half to catch up in: 5 ms
-- more, so at most 15 are late; the last one held makes one late at the least.
flown_through("the host's frames held for 2 ms each", { kind = "can_late", device = "pod/host", value = "2 ms", duration = "5 ms" },
              { lost = { 0, 0 }, late = { 1, 15 } })
-- Sent again 0.16 ms later; it had 100 us, and the one behind it waits for it.
flown_through("one frame spoiled", { kind = "can_bit_error", bus = bus, value = 7, duration = "1 s" },
              { lost = { 0, 0 }, late = { 0, 3 } },
              function(t) t:can { bus = bus, errors = 1, during = "900 ms" } end)
-- Both ends go bus-off after 32 errors, which drops what waits, and come back.
flown_through("every frame spoiled for 5 ms", { kind = "can_bit_error", bus = bus, duration = "5 ms" },
              { lost = { 0, 8 }, late = { 0, 15 }, some = 1 })

-- Without the pod's host there is no sample, and nobody hears what the ESCs are told: as if all sensors and ESCs had gone. The ESCs
-- stop by their own time-out of 0.5 s; the flight controller, which hears no data-ready, stops as it does on its own sensors.
pod_plan("pod on CAN: the host cut off for good", function(t)
  hovers(t)
  t:wait(t:drawn("0 s", "2 s"))
  t:fault { kind = "can_cut", device = "pod/host" }
  t:within("800 ms", no_rotor_is_driven, "no rotor is driven")
  t:within("2 s", function(s) return s.told_armed == 0 end, "motors off")
end, board)
