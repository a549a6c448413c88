// Shafts that somebody else steps (a board's process has the power stage, its windings and its rotor's
// inertia), on the vehicle's one pack.
//
//   Exchange at each boundary, dt (1 ms) apart. At t: load() of each shaft, which holds until t + dt. At
//            t + dt: receive() what each shaft did since t, then step(). Nothing crosses in between
//   Supply   One pack of source voltage S behind R feeds N shafts and the avionics. A shaft feels its
//            own current at once, the others' of the last step: from boundary to boundary it is
//            given a source of S - R (sum of all currents) + k R (its own), behind k R, with
//            k = max(1, N/2), currents being the means of the last step. Whatever k, steady
//            currents put every shaft at the voltage S - R (sum); k = 1 is exact for one shaft.
//   Damping  For shafts that answer a voltage within dt like a conductance G, a step leaves of an error
//            (k - N) R G / (1 + k R G) where all change alike, k R G / (1 + k R G) where their sum
//            stays. Both are below 1 for every G exactly if k >= N/2, and equal at N/2. With
//            k = 1 twelve shafts at full duty on 30 mohm swing from boundary to boundary.
//   Error    In a step in which currents change by d, a shaft is fed k R d(own) - R d(sum) too little
//            voltage, and the pack gives that x own current x dt too much: none while currents
//            are steady. EnergyBooks::exchange_J has that and nothing else, bound_J() what the currents make it
//            at most. i (i - i') = (i^2 - i'^2) / 2 + (i - i')^2 / 2, with i' the current that the load was made
//            of, one step before or two (its age). The first half telescopes: |k x sum of i^2 - (sum of i)^2| R dt / 2
//            for each step of age, nothing once all are at rest again. The second is at most k R dt d^2 / 2 for
//            each shaft and step, as k >= N/2. So a jump by D costs at most k R dt D^2 / 2 x age, and its decay
//            with the shaft's time constant T (inertia x resistance / torque constant^2) a share dt / T of
//            that. What ripple within a step heats k R by is battery_J's. Against the averaged powertrain, dt 1 ms,
//            four motors on 30 mohm (tests/remote_powertrain_test.cpp): hover 1e-8 of the energy,
//            duty 0.3 to 0.6 at once 31 mJ of 162 J (bound 66 mJ) and 0.2 % of speed at worst, a
//            flight with a push 3e-5
//   Dip      a fault in one shaft's lead takes so many volts of its source; what that takes of the energy is
//            battery_J's, as that of the pack's own dip is
//   Left out the capacitors of the other shafts' boards; warm windings (a board's own matter)
#pragma once
#include <deque>
#include <optional>
#include <vector>

#include "plant/battery/battery.hpp"
#include "plant/powertrain.hpp"

namespace whirl::plant {

struct RemoteShaftLoad {      // from this boundary to the next
  double torque_Nm_s2 = 0.0;  // of the air, over the square of speed
  double brake_Nm = 0.0;      // against the turning, and holds the shaft once it stands
  double source_V = 0.0;      // of what feeds it, behind its resistance
  double source_ohm = 0.0;
};

struct RemoteShaftState {  // since the last boundary; speed at this one
  double speed_radps = 0.0;
  double source_current_A = 0.0;  // mean, out of what feeds it; negative when it feeds the pack
  double winding_peak_A = 0.0;    // largest magnitude
  double electrical_in_J = 0.0;   // into the bridge, and where it went:
  double copper_J = 0.0, diode_J = 0.0, no_load_J = 0.0;
  double magnetic_J = 0.0, kinetic_J = 0.0, air_J = 0.0;
  double source_J = 0.0;     // what feeds it has given; of that
  double feed_J = 0.0;       // heat of its resistance, and
  double capacitor_J = 0.0;  // into a capacitor before the bridge
};

class RemotePowertrain final : public Powertrain {
 public:
  // inertia_kgm2: of each shaft with its propeller.
  RemotePowertrain(std::size_t motors, const BatteryParams& battery, double avionics_current_A,
                   double inertia_kgm2);

  RemoteShaftLoad load(std::size_t motor) const;
  // Counts from the step that follows. Pre: once for each shaft before each step.
  void receive(std::size_t motor, const RemoteShaftState& state);

  std::size_t count() const override { return shafts_.size(); }
  double source_V() const override { return battery_.source_V(); }
  double speed_radps(std::size_t motor) const override { return shafts_.at(motor).speed_radps; }
  // Who steps the shaft has to start it there.
  void set_speed(std::size_t motor, double speed_radps) override;
  // The shaft slows down by its brake, and its owner says how.
  void block(std::size_t motor) override;
  // Pre: never called. The bridge of a remote shaft is its owner's.
  void command(std::size_t motor, const MotorCommand& command) override;
  void set_loads(std::span<const ShaftLoad> loads) override;
  void set_dip(double below_V) override { battery_.set_dip(below_V); }
  // Of one shaft's source alone; from its next load() on.
  void set_shaft_dip(std::size_t motor, double below_V);
  void step(double dt_s, PowertrainState& state) override;

  // Of the sum of exchange_J since all stood.
  double bound_J() const { return ends_J_ + jumps_J_ + source_drift_J_; }
  // How many steps old are the currents that made the load under which a shaft did what is received: 1, or
  // 2 where the shafts run while the vehicle takes the same step.
  void set_age(std::size_t steps) { age_ = steps; }

 private:
  struct Past {
    std::vector<double> currents_A;
    double source_V = 0.0;
  };
  double total_current_A() const;  // of the last step
  double undipped_V(std::size_t motor) const;
  std::vector<double> take_dips();
  void count_bound(double dt_s);
  double end_J(const Past& past, double dt_s) const;

  Battery battery_;
  double avionics_current_A_, inertia_kgm2_;
  double share_;  // k above
  // One of each for each motor:
  std::vector<RemoteShaftState> shafts_;
  std::vector<std::optional<RemoteShaftState>> received_;  // of the step to come
  std::vector<double> torque_Nm_s2_, brake_Nm_;
  std::vector<double> dip_V_;
  std::deque<std::vector<double>> dips_V_;  // of the latest loads, the latest last
  // For the bound:
  std::size_t age_ = 1;
  std::deque<Past> past_;  // the latest last
  double jumps_J_ = 0.0, source_drift_J_ = 0.0, ends_J_ = 0.0;
};

}  // namespace whirl::plant
