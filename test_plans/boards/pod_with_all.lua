-- The pod's board in the place of all that it can play: sensors, ESCs, GPS, receiver, telemetry radio and the battery's divider.
local board = include "pod_with_receivers.lua"
board.board = "pod_with_all"
board.devices[1].params.radio = true
board.devices[1].params.battery = true
return board
