-- Constants of seed 1's copy with its motor and the hk_10x4.5, as `whirl calibrate esc` found them. Those of other
-- copies: whirl run --seeds 7 --calibrations results/calibrations/hk_10x4.5_typical
local stored = include "include/hk_10x4.5_typical_calibration.lua"

-- Types them at rest; they hold until power-down, or for ever after `save`.
function calibrate(t)
  t:step "calibrate"
  for _, line in ipairs(stored.set) do t:ask(line, "^ok$") end
  t:ask("identified 1", "^ok$")
end

-- Told by its serial line alone, with its stream, calibrated, and after the 100 s in which its current sense settles.
function calibrated_and_warm(t)
  t:wait "200 ms"
  t:ask("watch 0", "^ok$")
  t:command { silence = true }
  calibrate(t)
  t:ask("stream 100", "^ok$")
  t:wait "100 s"
end
