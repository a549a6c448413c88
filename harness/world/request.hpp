// What a plan, or a bench, can ask of a world, as data: commands to who flies or turns, disturbances of
// the air. A world does what it understands and refuses the rest; it never passes one over.
//
//   Units    SI, times in ns where they are on the wire's clock
//   Words    each has the key by which a plan writes it (test_plans/README.md): word()
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/result.hpp"

namespace whirl {

namespace request {

struct Arm {
  bool arm = true;     // false: disarm
  bool force = false;  // whatever state it is in
};
struct TakeOff {
  double height_m = 0.0;  // above 0
};
struct GoTo {  // what is left out stays as it was
  std::optional<double> north_m, east_m, height_m, yaw_rad;
  std::optional<double> speed_mps;  // above 0: straight there at that speed; left out: at once
};
struct Land {};
struct Figure8 {  // x = north cos(2 pi t / period), y = east sin(4 pi t / period), from now on
  double north_m = 1.0, east_m = 1.0, height_m = 1.1, period_s = 20.0;  // the last two above 0
};
struct Cruise {  // a velocity over ground, at a height
  double north_mps = 0.0, east_mps = 0.0;
  std::optional<double> height_m;  // left out: as it was
};
struct HoldAttitude {  // what is left out: the heading stays
  double roll_rad = 0.0, pitch_rad = 0.0;
  std::optional<double> yaw_rad;
  double yaw_rate_radps = 0.0;
  double thrust = 0.5;  // share of the vehicle's range, 0..1
};
struct SetParameter {           // of the firmware, over the radio
  std::string name;             // 1 to 16 characters
  std::optional<double> value;  // within a float's range; left out: only asked for
};
struct Sticks {  // of a radio-control transmitter; what is left out stays as it was
  std::optional<double> roll, pitch,
      yaw;                       // shares of full travel, -1..1; right, back and right are +
  std::optional<double> thrust;  // 0..1 from the lower stop
  std::optional<int> mode;       // position 1..3 of a switch
  std::optional<bool> arm;       // another switch, on or off
  bool transmitter_on = true;
};

struct Radio {  // bytes as they stand, into the radio: what another ground station sends
  std::vector<std::uint8_t> bytes;  // 1 to 280, the longest frame
};
struct Waypoint {
  double north_m = 0.0, east_m = 0.0, down_m = 0.0, yaw_rad = 0.0;
  double hold_s = 0.0;  // how long it stays there before the next one
};
struct Waypoints {               // one after the other: straight there, there, held, then the next
  std::vector<Waypoint> points;  // one at least
  double speed_mps = 0.5;        // of the commanded place
  double within_m = 0.1;         // so near is there
};
struct Stick {  // of a teleoperation: where a person has been told to move it, from now on
  double at_s = 0.0;
  // Left out: as before.
  std::optional<double> north_mps = {}, east_mps = {}, height_m = {}, yaw_rate_radps = {};
};
struct Teleoperation {        // velocity over ground, height and heading, by a person's hand
  std::vector<Stick> script;  // in order of time, one at least
  double reaction_s = 0.25;   // from what is seen to the hand's first movement
};

enum class SetPointKind { duty, speed, thrust, power };
struct SetPoint {
  SetPointKind kind = SetPointKind::duty;
  double value_SI = 0.0;  // a share, rad/s, N, W; not negative
};
struct Stop {};  // set-point 0
struct Silence {
  bool silent = true;  // no more set-points
};
struct SetPointRate {
  double rate_Hz = 50.0;  // 1 Hz to 10 kHz
};
struct RawTransfer {  // a transfer on the ESC's bus as it stands, some times over
  std::vector<std::uint8_t> write;
  std::uint16_t read = 0;                        // bytes
  std::int64_t times = 1, every_ns = 1'000'000;  // whole milliseconds
  std::int64_t shift_ns = 0;                     // moves it within its millisecond each time
};
struct Pulses {  // on the throttle pin; all within the period
  std::int64_t width_ns = 0, period_ns = 20'000'000;
  std::int64_t glitch_ns = 0, glitch_after_ns = 0;
};
struct Line {
  std::string text;  // on the serial line, without its end
};
struct Brake {
  double torque_Nm = 0.0;  // 0: lets go; negative: drives backward, as rising air does
};

struct Wind {  // where the air goes to; frame W
  std::optional<double> north_mps = {}, east_mps = {}, down_mps = {};
  std::optional<double> duration_s = {}, edge_s = {}, after_s = {};  // not negative
};
struct Jet {  // a round vertical stream, from now on
  double up_mps = 0.0, north_m = 0.0, east_m = 0.0;
  double radius_m = 0.0;         // above 0
  std::optional<double> edge_m;  // above 0
};

// A magnetised thing or a loaded cable: `field` everywhere within `radius` of its place, beyond it less by
// the cube of the distance, as a dipole's; without a radius everywhere. Frame W.
struct Magnet {
  double north_T = 0.0, east_T = 0.0, down_T = 0.0;
  double at_north_m = 0.0, at_east_m = 0.0, at_height_m = 0.0;
  std::optional<double> radius_m;    // above 0
  std::optional<double> duration_s;  // above 0; left out: for ever
};

struct Hold {  // by hand, and turn it there; frame W
  double roll_rad = 0.0, pitch_rad = 0.0, yaw_rad = 0.0;
  std::optional<double> height_m, north_m, east_m;  // left out: as it was, but high enough
  double over_s = 2.0;                              // above 0
};
struct Release {
  std::optional<double>
      over_s;  // above 0: put down on its gear first; left out: let go where it is
};

enum class Calibration { gyroscope, accelerometer, magnetometer, motor_fields, cancel };
struct Calibrate {  // the vehicle's sensors, by its own procedure
  Calibration what = Calibration::gyroscope;
};

}  // namespace request

using Command =
    std::variant<request::Arm, request::TakeOff, request::GoTo, request::Land, request::Figure8,
                 request::Cruise, request::HoldAttitude, request::Waypoints, request::Teleoperation,
                 request::Radio, request::SetParameter, request::Sticks, request::SetPoint,
                 request::Stop, request::Silence, request::SetPointRate, request::RawTransfer,
                 request::Pulses, request::Line, request::Brake, request::Calibrate>;
using Disturbance =
    std::variant<request::Wind, request::Jet, request::Magnet, request::Hold, request::Release>;

const char* word(const Command& command);          // "takeoff"
const char* word(const Disturbance& disturbance);  // "jet"

// The refusal of one that this world ("a flight") has no use for. The place of this and of every other
// refusal is the key that it is about; who has read the request adds file and line.
Error not_understood(const std::string& world, const char* word);
Error refusal(const char* key, const std::string& what, const char* cure = "");

// An overload set for std::visit out of lambdas.
template <typename... Cases>
struct Match : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>  // clang 14 does not deduce aggregates by itself
Match(Cases...)->Match<Cases...>;

}  // namespace whirl
