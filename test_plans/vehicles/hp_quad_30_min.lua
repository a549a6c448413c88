-- The HP quad on a pack that lasts for half an hour and weighs what the other does: three times its charge, and all else of
-- it, so that after 30 minutes it is where the other is after ten (test_plans/flight/endurance.lua).
local quad = include "hp_quad.lua"
quad.name = "HP quad with a pack of 6600 mAh"
quad.battery = { pack = "4s_2200", capacity = "6600 mAh" }
return quad
