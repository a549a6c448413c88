-- A pad with two sticks, as `whirl fly --stick` takes it (harness/live/stick_file.hpp): put in the numbers of your own. Axes
-- are numbered as the device has them; what they read at their stops, `evtest` or `jstest` shows.
return {
  stick = "pad", vendor = 0x046D, product = 0xC216,
  axes = {
    yaw = { axis = 1, min = 0, centre = 128, max = 255, dead_zone = 6 },
    thrust = { axis = 2, min = 0, max = 255, reversed = true },
    roll = { axis = 3, min = 0, centre = 128, max = 255, dead_zone = 6 },
    pitch = { axis = 4, min = 0, centre = 128, max = 255, dead_zone = 6 },
  },
  arm = 9, modes = { 1, 2, 3 },
}
