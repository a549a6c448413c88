-- The same behind a host whose samples leave up to a millisecond late, at random, as through an adapter on USB.
local board = include "pod_with_parts.lua"
board.board = "pod_with_jitter"
board.devices[1].params = { jitter = "1 ms" }
return board
