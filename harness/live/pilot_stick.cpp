#include "harness/live/pilot_stick.hpp"

#include <algorithm>
#include <cstdio>

#include "base/units.hpp"

namespace whirl::live {
namespace {

// As a plan that says so reads it, to the bit.
double in_steps(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", 100.0 * share);
  return parse_quantity_as(text, Dimension::ratio, "a stick").value();
}

}  // namespace

Result<PilotStick> PilotStick::start(std::unique_ptr<io::HidPort> port, StickMap map) {
  auto controller = io::GameController::start(std::move(port), map.calibrations);
  if (!controller) return controller.error();
  const std::size_t buttons = controller.value().poll(0).buttons.size();
  std::size_t most = map.arm;
  for (const std::size_t button : map.modes) most = std::max(most, button);
  if (most > buttons) {
    return Error{ErrorKind::bad_input, map.device.kind, "has no button " + std::to_string(most),
                 "it has " + std::to_string(buttons)};
  }
  return PilotStick(std::move(controller.value()), std::move(map));
}

bool PilotStick::pressed(const io::StickState& state, std::size_t button) const {
  return button != 0 && state.buttons[button - 1];
}

request::Sticks PilotStick::read() {
  const io::StickState& state = controller_.poll(0);
  request::Sticks sticks;
  sticks.transmitter_on = state.present;
  if (!state.present) return sticks;
  const auto travel = [&](StickMap::Axis stick) -> std::optional<double> {
    const std::size_t number = map_.axis[stick];
    if (number == 0) return std::nullopt;
    return in_steps(state.axes[number - 1]);
  };
  sticks.roll = travel(StickMap::roll);
  sticks.pitch = travel(StickMap::pitch);
  sticks.yaw = travel(StickMap::yaw);
  sticks.thrust = travel(StickMap::thrust);
  const bool arm = pressed(state, map_.arm);
  if (arm && !arm_pressed_) arm_ = !arm_;
  arm_pressed_ = arm;
  sticks.arm = arm_;
  for (std::size_t i = 0; i < map_.modes.size(); ++i) {
    if (pressed(state, map_.modes[i])) mode_ = static_cast<int>(i) + 1;
  }
  sticks.mode = mode_;
  return sticks;
}

}  // namespace whirl::live
