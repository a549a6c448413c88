-- The pod's board in the place of all of a flight controller's sensors: its host has a GPS and a receiver as well. The
-- first fix comes after 5 s, where a cold start takes 29: so long does the flight not wait on two boards.
local board = include "pod_with_parts.lua"
board.board = "pod_with_receivers"
board.devices[1].params = { gps = true, first_fix = "5 s", receiver = true }
return board
