-- Sets a parameter and waits until the vehicle holds it.
function set_parameter(t, name, value)
  t:command { parameter = { name = name, value = value } }
  t:within("3 s", function(s) return s.parameter_pending == 0 end, name .. " is answered")
  t:expect(t:value "parameter_result", name .. " is taken over"):equal(0)
end
