-- What the plans of the thrust stand share: arm, start, turn steadily.

-- Armed by its zeros, then turning for two seconds as `wish` says: a thrust, or what the mode takes.
function start(t, wish)
  t:step "start"
  t:within("3 s", function(s) return s.armed == 1 end, "armed after its zeros")
  t:command(type(wish) == "table" and wish or { thrust = wish })
  t:within("3 s", function(s) return s.speed_radps > 150 end, "turning")
  t:wait "2 s"
end

-- Where a change of thrust has led: to what was commanded, and without wandering on. `record`: thrust and another
-- signal, from the change on.
function ends(t, record, wanted_N, words)
  t:expect(record:final "thrust", "thrust after the " .. words)
      :within(0.97 * wanted_N .. " N", 1.03 * wanted_N .. " N")
  t:expect(record:settled("thrust", "3 %"), words .. " settled within 3 %"):at_most "150 ms"
end

-- Bit `number` of the status byte.
function flag(flags, number)
  return flags // 2 ^ number % 2 == 1
end

-- No more current than any plan allows, in a record of winding_peak and bus_peak. `words` say when, if need be.
function safe(t, record, words)
  local when = words and ", " .. words or ""
  t:expect(record:max "winding_peak", "winding current" .. when):at_most "30 A"
  t:expect(record:max "bus_peak", "bus current" .. when):at_most "22 A"
end

-- The supply falls until this copy's own divider and converter show `wanted_V`: what it arms by.
function sensed_at(t, wanted_V)
  local bus_V, sensed_V = t:value("bus_voltage", "V"), t:value("sensed_voltage", "V")
  t:fault { kind = "supply_dip", value = string.format("%.4f V", bus_V * (1 - wanted_V / sensed_V)) }
end
