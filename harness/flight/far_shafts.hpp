// The vehicle's shafts where boards of the run turn them: what their power stages did comes in, the air's torque
// and the bus go out, as plant/remote_powertrain.hpp exchanges them.
//
//   Late     the boards run while the world takes the same step, so a shaft's state is that of the step
//            before: load() of t acts in the board from t to t + 1 ms, and comes back into the step from t + 1 ms on
//   Bound    so the age of remote_powertrain.hpp is two steps. exchange_share() is what it has come to, and
//            exchange_of_bound() that beside what the currents allow: above 1 the books are wrong
//   First    nothing has been told in the first step: the shafts stand
#pragma once
#include <vector>

#include "harness/flight/flight_params.hpp"
#include "io_bridges/messages/messages.hpp"
#include "plant/remote_powertrain.hpp"

namespace whirl::flight {

class FarShafts {
 public:
  // powertrain: the vehicle's, which outlives this; one of shafts for each of its motors.
  FarShafts(std::vector<FarShaft> shafts, plant::RemotePowertrain& powertrain);

  bool hears(const io::Header& head) const;
  void on_message(const io::Reader& message);  // one that it hears
  void before_step();                          // of the vehicle
  void after_step(const plant::EnergyBooks& books);
  void set_dip(std::size_t motor, double below_V) { powertrain_.set_shaft_dip(motor, below_V); }
  void send(std::int64_t t_ns, io::Batch& sensed) const;

  // So far, as shares of what the pack has given:
  double exchange_share() const;  // between pack and shafts
  double gap_share() const;  // of what the supply gave the boards: what their books do not name
  double exchange_of_bound() const;  // no share of the pack's: of RemotePowertrain::bound_J()

 private:
  std::vector<FarShaft> shafts_;
  plant::RemotePowertrain& powertrain_;
  std::vector<plant::RemoteShaftState> states_;
  double chemical_J_ = 0.0, exchange_J_ = 0.0, gap_J_ = 0.0;
};

}  // namespace whirl::flight
