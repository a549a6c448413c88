-- The vehicle as it was: the flight controller and its four motor controllers, each with its own image on its own
-- part, joined on the flight controller's I2C3. The four ESCs have one image; what makes one the second is its page of
-- settings. `watch` is of the flight controller, `of_escs` of each ESC.
function chain_nodes(watch, of_escs)
  local nodes = { { name = "flight", image = "flight", board = "px4fmu_v1", watch = watch } }
  for n = 1, 4 do
    nodes[n + 1] = { name = "esc" .. n, image = "esc", board = "esc32v2", flash = { "esc_motor_" .. n },
                     watch = of_escs }
  end
  return nodes
end

function chain_wires()
  local wires = {}
  for n = 1, 4 do wires[n] = { from = "flight.esc" .. n, to = "esc" .. n .. ".i2c2" } end
  return wires
end

-- What five boards have to keep of the vehicle's energy, to be judged at the end: between the pack and the power
-- stages that the ESCs' boards step, and within those. Of some 2 kJ of a hover: ripple of 20 kHz in the 60 mohm of
-- each stage's feed, 0.6 to 0.8 A rms beside its 470 uF, 0.1 to 0.15 %; the charging of four such capacitors, 0.5 J;
-- 2 R dt I^2 for each rise of all currents at once, 0.1 J.
function judged_energy(t)
  t:expect(t:value("exchange_share"), "energy between the pack and the boards' power stages"):at_most "0.2 %"
  t:expect(t:value("stage_gap_share"), "energy that the power stages' books do not name"):at_most "0.01 %"
end
