// A flight: the vehicle in its air, a controller for each motor, the capture system and the ground station.
//
//   Motors   turned by native controllers, or by boards of the run (far_shafts.hpp)
//   Step     controllers and station take what the target did; then everything moves 1 ms; then what is
//            sensed goes out: body_motion, esc_state of each motor, uart_frame to the radio
//   Command  Arm, TakeOff, GoTo, Figure8, Cruise, HoldAttitude, Waypoints, Teleoperation, Land, Sticks, SetParameter, Radio. Take-off also streams the point above where the vehicle stands
//            as its target; land and disarm end the stream
//   Radio    bytes of another ground station go up with the next step. Who commanded last leads: with a set-point, an
//            arming, a take-off or a landing of the other one ours ends its own set-points until it is commanded anew
//   Begins   standing at W's origin, or as the plan's `start` says (surroundings.hpp)
//   Disturbed by Wind with a duration, Jet, Magnet; held and turned by Hold until Release (flight_hand.cpp)
//   Faults   capture_lost; capture_frozen (the pose that was sent last goes on); capture_moved (each pose lies value metres
//            further north); capture_turned (each is turned by value radians about W's third axis); supply_dip (value: volts below; of all, or of the
//            lead of one motor's controller where that is a board); esc_stopped (of a motor, or of the device that
//            is its ESC); winding_short (of one likewise; value: amperes of the bus) (flight_faults.cpp)
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/flight/capture.hpp"
#include "harness/flight/controllers.hpp"
#include "harness/flight/drag_truth.hpp"
#include "harness/flight/estimates.hpp"
#include "harness/flight/far_parts.hpp"
#include "harness/flight/far_shafts.hpp"
#include "harness/flight/flight_params.hpp"
#include "harness/flight/guest_radio.hpp"
#include "harness/flight/hand.hpp"
#include "harness/flight/receiver.hpp"
#include "harness/flight/station.hpp"
#include "harness/flight/transmitter.hpp"
#include "harness/flight/waypoint_flight.hpp"
#include "harness/world/world.hpp"
#include "plant/vehicle.hpp"

namespace whirl::flight {

inline constexpr std::uint16_t kRadioPort = 2;  // USART2

class FlightWorld : public World {
 public:
  FlightWorld(const FlightParams& params, std::uint64_t seed);
  // The same with rotors and controllers of the caller's choice, for tests.
  FlightWorld(const FlightParams& params, plant::RotorSet rotors, std::uint64_t seed,
              const ControllerTypes& types = controller_types());

  const std::vector<Signal>& signals() const override { return signals_; }
  void read(std::span<double> values) const override;
  bool hears(const io::Header& head) const override {
    return (far_ && far_->hears(head)) || far_parts_.hears(head) || far_parts_.finds(head) ||
           far_parts_.is_esc(head) ||
           ((head.kind == io::Kind::uart_received || head.kind == io::Kind::uart_delivered) &&
            is_radio(head));
  }
  void step(std::int64_t t_ns, const io::Batch& happened, io::Batch& sensed) override;
  Result<Done> command(const Command& command, std::int64_t now_ns) override;
  Result<Done> disturb(const Disturbance& disturbance, std::int64_t now_ns) override;
  const std::vector<std::string>& told_texts() const override { return station_.texts(); }
  Result<Done> say(const std::string& line) override { return far_parts_.say(line); }
  const std::vector<std::string>& heard() const override { return far_parts_.heard(); }
  std::int64_t command_on_wire_ns() const override { return station_.on_wire_ns(); }
  Result<bool> take_fault(const FaultSpec& fault) override;
  std::vector<std::uint32_t> applied_faults() const override { return faults_.acted(); }
  const std::vector<DrawnPart>& drawn_parts() const override { return drawn_; }
  const std::vector<std::string>& doubts() const override { return doubts_; }
  std::string status() const override;

  const plant::VehicleState& truth() const { return vehicle_.state(); }

 private:
  bool is_radio(const io::Header& head) const {
    return head.board == ears_.radios_board && head.port == kRadioPort;
  }
  plant::Vehicle make_vehicle(const FlightParams& params, plant::RotorSet rotors,
                              std::uint64_t seed);
  void make_controllers(const FlightParams& params, std::uint64_t seed,
                        const ControllerTypes& types);
  void begin(const Start& start);
  void on_messages(const io::Batch& happened);
  void move(std::int64_t t_ns);
  void send(std::int64_t t_ns, io::Batch& sensed);
  void apply_faults(std::int64_t t_ns);
  Result<Done> must_be_of_a_controller(const FaultSpec& fault) const;
  Result<Done> must_be_a_lead(const FaultSpec& fault) const;
  void dip_leads(std::int64_t t_ns);
  void add_signal(std::string name, Dimension dimension, std::string about,
                  std::function<double()> value);
  void name_signals();
  void name_fence_signals();
  void name_load_signals();
  void name_motor_signals();
  void name_controller_signals(std::size_t motor);
  void name_exchange_signals();
  void name_telemetry_signals();
  void name_estimate_signals();
  void name_receiver_signals();
  Result<Done> must_be_heard(const Command& command) const;
  void name_sensor_signals();
  void arm(const request::Arm& command);
  void take_off(const request::TakeOff& command);
  void go_to(const request::GoTo& command);
  void land();
  CapturedPose spoiled(CapturedPose pose, std::int64_t t_ns);
  void fly_figure_8(const request::Figure8& figure);
  void cruise(const request::Cruise& command);
  void hold_attitude(const request::HoldAttitude& command);
  void fly_waypoints(const request::Waypoints& wanted);
  void teleoperate(const request::Teleoperation& wanted);
  void add_guest(const request::Radio& radio);
  void calibrate(const request::Calibrate& command);
  Result<Done> hold_in_hand(const request::Hold& wanted, std::int64_t now_ns);
  Result<Done> release(const request::Release& wanted, std::int64_t now_ns);
  void carry(std::int64_t t_ns);
  double standing_m() const;
  bool free_of_obstacles(const Grip& at, double within_m) const;
  Target present_target() const;  // as commanded; where it is, if nothing was
  Result<Done> blow(const request::Wind& wind, std::int64_t now_ns);
  Result<Done> add_jet(const request::Jet& wanted);
  Result<Done> add_magnet(const request::Magnet& wanted, std::int64_t now_ns);
  double offset_from_target_m() const;

  Surroundings place_;
  bool has_load_;
  BoardEars ears_;
  FarParts far_parts_;
  plant::RemotePowertrain* remote_ = nullptr;  // the vehicle's, where boards turn its shafts
  plant::Vehicle vehicle_;
  std::optional<FarShafts> far_;
  std::vector<std::unique_ptr<MotorController>>
      controllers_;                  // index: motor number - 1; none if far
  std::vector<double> shorts_A_;     // of the motor of each, in the step to come
  std::vector<double> unbalance_m_;  // likewise, over the vehicle's mass
  const plant::AirframeParams airframe_;
  const std::vector<plant::Obstacle> obstacles_;
  std::uint64_t seed_;
  std::vector<DrawnPart> drawn_;
  std::vector<std::string> doubts_;
  std::optional<Hand> hand_;
  Capture capture_;
  Station station_;
  GuestRadio guest_;
  std::shared_ptr<WaypointFlight> waypoints_;  // of the latest command; shared with the station
  Estimates estimates_;
  Receiver receiver_;
  DragTruth drag_truth_;
  Transmitter transmitter_;
  TimedFaults faults_;
  std::vector<Signal> signals_;
  std::vector<std::function<double()>> values_;
  std::int64_t now_ns_ = 0;
  std::uint32_t setpoints_refused_ = 0;
};

}  // namespace whirl::flight
