-- The vehicle as it was: the flight controller and its four motor controllers, each with its own image on its own
-- part, joined on the flight controller's I2C3; with `can`, on its CAN2. The four ESCs have one image; what makes one the
-- second is its page of settings, on CAN the number of its node too. `watch` is of the flight controller, `of_escs` of each ESC.
function chain_nodes(watch, of_escs, can)
  local nodes = { { name = "flight", image = "flight", board = can and "px4fmu_v1_can" or "px4fmu_v1", watch = watch } }
  for n = 1, 4 do
    nodes[n + 1] = { name = "esc" .. n, image = "esc", board = can and "esc32v2_can" or "esc32v2", flash = { "esc_motor_" .. n },
                     watch = of_escs }
  end
  return nodes
end

function chain_wires(can)
  local wires, bus = {}, can and ".can1" or ".i2c2"
  for n = 1, 4 do wires[n] = { from = "flight.esc" .. n, to = "esc" .. n .. bus } end
  return wires
end

-- What five boards have to keep of the vehicle's energy, to be judged at the end. What the exchange of currents and
-- voltage at the grain of 1 ms loses or gains is at most what the changes of the currents allow
-- (plant/remote_powertrain.hpp): k R dt d^2 / 2 for each shaft and step, 60 mohm x 1 ms / 2 here, beside what begin and end
-- leave. In a hover a shaft's current of 1.35 A changes from step to step by no more than the charge of one of its 2.8
-- commutations in 1 ms, 0.5 A: 30 mW of 84 W. Four starts with jumps of 10 A are 2 x 24 mJ of 2 kJ. So 0.04 %.
-- `name`: what these figures' names begin with.
function judged_energy(t, name)
  name = name or ""
  t:expect(t:value("exchange_share"), name .. "energy between the pack and the boards' power stages"):at_most "0.04 %"
  t:expect(t:value("exchange_of_bound"), name .. "the same, of what the currents allow"):at_most "100 %"
  t:expect(t:value("stage_gap_share"), name .. "energy that the power stages' books do not name"):at_most "0.01 %"
end
