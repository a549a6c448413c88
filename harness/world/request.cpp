#include "harness/world/request.hpp"

namespace whirl {

const char* word(const Command& command) {
  return std::visit(Match{[](const request::Arm&) { return "arm"; },
                          [](const request::TakeOff&) { return "takeoff"; },
                          [](const request::GoTo&) { return "position"; },
                          [](const request::Land&) { return "land"; },
                          [](const request::Figure8&) { return "figure_8"; },
                          [](const request::Cruise&) { return "velocity"; },
                          [](const request::HoldAttitude&) { return "attitude"; },
                          [](const request::Waypoints&) { return "waypoints"; },
                          [](const request::Teleoperation&) { return "teleoperation"; },
                          [](const request::Radio&) { return "radio"; },
                          [](const request::SetParameter&) { return "parameter"; },
                          [](const request::Sticks&) { return "rc"; },
                          [](const request::SetPoint& s) {
                            constexpr const char* kWords[] = {"duty", "speed", "thrust", "power"};
                            return kWords[static_cast<std::size_t>(s.kind)];
                          },
                          [](const request::Stop&) { return "stop"; },
                          [](const request::Silence&) { return "silence"; },
                          [](const request::SetPointRate&) { return "setpoint_rate"; },
                          [](const request::RawTransfer&) { return "i2c_raw"; },
                          [](const request::Pulses&) { return "pulses"; },
                          [](const request::Line&) { return "line"; },
                          [](const request::Brake&) { return "brake"; },
                          [](const request::Calibrate&) { return "calibrate"; }},
                    command);
}

const char* word(const Disturbance& disturbance) {
  return std::visit(
      Match{[](const request::Wind&) { return "wind"; }, [](const request::Jet&) { return "jet"; },
            [](const request::Magnet&) { return "magnet"; },
            [](const request::Hold&) { return "hold"; },
            [](const request::Release&) { return "release"; }},
      disturbance);
}

Error not_understood(const std::string& world, const char* word) {
  return refusal(word, "means nothing to " + world);
}

Error refusal(const char* key, const std::string& what, const char* cure) {
  return {ErrorKind::bad_input, key, what, cure};
}

}  // namespace whirl
