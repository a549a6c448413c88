// A person's game controller or trainer stick, as a file of Lua tells which axis and button is which.
//
//   return { stick = "pad", vendor = 0x046D, product = 0xC216, serial = "...",
//            axes = { roll = { axis = 3, min = 0, centre = 128, max = 255, dead_zone = 4, reversed = false }, pitch = ...,
//                     yaw = ..., thrust = { axis = 2, min = 0, max = 255, reversed = true } },
//            arm = 1, modes = { 2, 3, 4 } }
//
//   Axes     by number from 1, in the order of the device's own descriptor; counts as it reports them. Thrust has no middle
//   Buttons  by number from 1: `arm` turns the arm switch over, a button of `modes` puts the mode switch there
//   Errors   bad_input, with the line
#pragma once
#include <array>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/hid/game_controller.hpp"
#include "io_bridges/hid/hid_device.hpp"

namespace whirl::live {

struct StickMap {
  io::HidQuery device;
  enum Axis : std::size_t { roll, pitch, yaw, thrust };
  std::array<std::size_t, 4> axis{};              // by number from 1; 0: it has none
  std::vector<io::AxisCalibration> calibrations;  // of the device's axes, as far as they are named
  std::size_t arm = 0;                            // button; 0: none
  std::vector<std::size_t> modes;
};

Result<StickMap> read_stick(const std::string& path);

}  // namespace whirl::live
