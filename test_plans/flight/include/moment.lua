-- When something happens to a vehicle that hovers: at a moment of the next four seconds that the seed draws, so that each
-- seed meets another phase of set-points, status reads, fixes and telemetry.
function some_moment(t) t:wait(t:drawn("0 s", "4 s")) end
