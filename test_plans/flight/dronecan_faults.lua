-- Faults of the ESCs' CAN bus in flight. Those that pass leave the vehicle where it is, by the limits of
-- faults_wire.lua; those that last are noticed, and the motors cut, as on I2C.
include "include/fail_safe.lua"
include "include/hover.lua"
include "include/moment.lua"
include "include/parameter.lua"

local function hover_on_can(t)
  t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  set_parameter(t, "ESC_BUS", 1)
  hover(t)
  some_moment(t)
end

-- The vehicle stays where it was while `fault` acts and for a second more; `look` opens windows beside.
local function unmoved(name, fault, look)
  plan(name) {
    image = "flight", board = "px4fmu_v1_can", vehicle = "hp_quad",
    tags = { "flight", "faults", "can" }, timeout = "60 s",
    run = function(t)
      hover_on_can(t)
      local record = t:record({ "height", "offset", "tilt" }, "2 s", function()
        t:fault(fault)
        if look then look(t) end
      end)
      t:expect(record:max "height", name .. ": highest"):at_most "1.2 m"
      t:expect(record:min "height", name .. ": lowest"):at_least "1.0 m"
      t:expect(record:max "tilt", name .. ": tilt"):at_most "10 deg"
      t:expect(record:max "offset", name .. ": sideways"):at_most "20 cm"
      t:expect(t:value "told_armed", name .. ": flies on"):equal(1)
    end,
  }
end

unmoved("CAN: every frame spoiled for 30 ms takes all nodes off the bus, and they come back",
        { kind = "can_bit_error", bus = "can2", duration = "30 ms" })
unmoved("CAN: the wire held dominant for 50 ms", { kind = "can_stuck_dominant", bus = "can2", duration = "50 ms" })
unmoved("CAN: no acknowledge for 50 ms", { kind = "can_no_ack", bus = "can2", duration = "50 ms" })
unmoved("CAN: an ESC cut off for 100 ms", { kind = "can_cut", device = "esc3", duration = "100 ms" })
unmoved("CAN: an ESC that misses frames for 100 ms", { kind = "can_lost", device = "esc3", duration = "100 ms" })
unmoved("CAN: frames that wait 5 ms before they may start",
        { kind = "can_late", bus = "can2", duration = "1 s", value = "5 ms" })
unmoved("CAN: one frame spoiled is sent again", { kind = "can_bit_error", bus = "can2", duration = "1 s", value = 7 },
        function(t) t:can { bus = "can2", errors = 1, during = "1 s" } end)
-- Set-points have priority 5, the babbling node 0: they get the gaps it leaves.
unmoved("CAN: a babbling node takes 95 % of the bus for a second",
        { kind = "can_babble", bus = "can2", duration = "1 s", value = 0.95 },
        function(t)
          t:can { bus = "can2", from = "mcu", message = 1030, period = "20 ms", tolerance = "2 ms", during = "1 s" }
        end)

-- Half a second is what both sides wait: the ESC for a set-point, the vehicle for an ESC. `deaf` ESCs stop by themselves; where it is
-- one, the vehicle cannot stop that one within 100 ms.
local function noticed(name, fault, deaf)
  plan(name) {
    image = "flight", board = "px4fmu_v1_can", vehicle = "hp_quad",
    tags = { "flight", "faults", "can" }, timeout = "90 s",
    run = function(t)
      hover_on_can(t)
      t:fault(fault)
      cuts(t, "an ESC is silent", { noticed = "500 ms", driven = #deaf == 1 and deaf[1] or nil })
      for _, esc in ipairs(deaf) do t:expect(t:value("esc_armed_" .. esc), "ESC " .. esc .. " heard nothing: armed"):equal(0) end
    end,
  }
end

noticed("CAN: an ESC cut off for good", { kind = "can_cut", device = "esc2" }, { 2 })
noticed("CAN: the bus cut for good", { kind = "can_cut", bus = "can2" }, { 1, 2, 3, 4 })
noticed("CAN: a babbling node takes all of the bus", { kind = "can_babble", bus = "can2" }, { 1, 2, 3, 4 })
