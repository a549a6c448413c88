-- The pod's board in the place of a flight controller's sensors, of its telemetry radio and of its battery's divider.
local board = include "pod_with_parts.lua"
board.board = "pod_with_radio"
board.devices[1].params = { radio = true, battery = true }
return board
