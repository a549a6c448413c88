-- The same with its host on CAN.
local board = include "pod_with_receivers.lua"
board.board = "pod_with_receivers_can"
board.devices[1].params.can = 2
return board
