-- PX4FMU v1 in a frame of soft iron that bends the earth's field by 5 %: it adds to the part along the nose,
-- takes from that across it, and turns from the one upright to the one along the nose.
local board = include "px4fmu_v1.lua"
board.board = "px4fmu_v1_soft_iron"
for _, device in ipairs(board.devices) do
  if device.name == "mag" then
    device.params = { soft_iron = { "5 %", "-5 %", "0 %" }, soft_iron_cross = { "0 %", "5 %", "0 %" } }
  end
end
return board
