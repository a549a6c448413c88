-- The same with its host on CAN.
local board = include "pod_with_parts.lua"
board.board = "pod_with_parts_can"
board.devices[1].params = { can = 2 }
return board
