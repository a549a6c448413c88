-- A board with a receiver that speaks SBUS on USART1 in the place of the other one.
return function(board, name)
  board.board = name
  for _, device in ipairs(board.devices) do
    if device.name == "rc" then
      device.name, device.type, device.bus, device.params = "sbus", "sbus", "usart1", nil
      device.inverter = true
    end
  end
  return board
end
