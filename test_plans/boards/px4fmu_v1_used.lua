-- PX4FMU v1 whose flash holds something where the flight image keeps its parameters: its first two
-- starts erase those sectors.
local board = include "px4fmu_v1.lua"
board.board = "px4fmu_v1_used"
board.boot_image = "../../build/firmware/images/used_sectors.elf"
return board
