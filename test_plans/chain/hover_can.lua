-- The flight of hover.lua with CAN in the place of I2C: the flight image and four ESC images, each on a board of its own, on one
-- CAN bus, which the flight controller's board arbitrates. They speak DroneCAN: the flight image by its parameter
-- ESC_BUS, each ESC as the node of its motor's number. Limits are those of hover.lua, and on the bus those of test_plans/flight/dronecan.lua;
-- an ESC's status goes out with a tick of its own 1 ms, behind what the others send.
include "include/chain.lua"
include "include/flights.lua"
include "include/hover.lua"

local raw_command, esc_status = 1030, 1034
local function can_windows(t)
  local bus = "flight/can2"
  t:can { bus = bus, from = "mcu", message = raw_command, period = "20 ms", tolerance = "0.5 ms", during = "20 s" }
  for _, esc in ipairs(escs) do
    t:can { bus = bus, from = esc, message = esc_status, period = "50 ms", tolerance = "1.5 ms", during = "20 s" }
  end
  t:can { bus = bus, load = "10 %", during = "20 s" }
end

chain_plan("chain hover on CAN", { timeout = "60 s", can = true, parity = true, of_escs = { "fw::esc::control_task" } },
           function(t, boards)
  t:step "boot"
  heartbeat_on_can(t)
  judged_hover(t, boards, can_windows)
end)
